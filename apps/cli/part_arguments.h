// The options that say how a model falls into parts.
#pragma once

#include <CLI/CLI.hpp>

#include "limber/actions/parts/model_parts.h"

namespace limber::cli {

struct PartArguments {
  std::string by = "auto", detail = "limbs";
  std::optional<Index> count;

  void addTo(CLI::App& command) {
    command
        .add_option("--by", by,
                    "parts by the skin's weights, by the shape alone, or auto: by weights where there is a rig")
        ->type_name("METHOD")
        ->capture_default_str();
    command.add_option("--detail", detail, "parts by weights: whole limbs, or what each of the joints moves")
        ->type_name("DETAIL")
        ->capture_default_str();
    command.add_option("--count", count, "parts by shape: so many; found from the shape by itself")
        ->check(CLI::Range(Index{1}, kMaxShapeParts))
        ->type_name("N");
  }

  bool given() const { return by != "auto" || detail != "limbs" || count; }

  // A count is a matter of shape alone. Throws Error kBadArgument for names that there are not, or where both go
  // against each other.
  PartOptions options() const {
    PartOptions options{parsePartMethod(by), parsePartDetail(detail), count};
    if (!count) return options;
    if (options.method == PartMethod::kWeights) {
      throw Error(ErrorCode::kBadArgument, "--count is for parts by shape", "", "add --by shape, or leave it out");
    }
    options.method = PartMethod::kShape;
    return options;
  }
};

}  // namespace limber::cli
