#include "clip_arguments.h"

#include <fmt/format.h>

namespace limber::cli {

namespace {

constexpr double kMillimetre = 1e-3;

}  // namespace

void ClipArguments::addTo(CLI::App& command) {
  const char* group = "Loops, root motion, fewer keys (in this order; docs/root-motion.md)";
  command.add_flag("--loop", edits.loop, "cut each clip to its best loop, where it has one, and join the ends")
      ->group(group);
  CLI::Option* inPlace =
      command.add_flag("--in-place", edits.inPlace, "walk on the spot: without the body's travel")->group(group);
  command
      .add_flag(
          "--root-joint{root}", rootJoint_,
          "hand the travel to a root joint; where there is none it is made, called root or as in --root-joint=NAME")
      ->each([this](const std::string& name) { edits.rootJoint = name; })
      ->excludes(inPlace)
      ->group(group);
  command
      .add_option_function<std::string>(
          "--root-motion",
          [this](const std::string& axes) {
            edits.height = axes.rfind("xyz", 0) == 0;
            edits.heading = axes.find("turn") != std::string::npos;
          },
          "what of the movement is travel: over the ground (xz, the default), up and down (y), turns about it (turn)")
      ->check(CLI::IsMember({"xz", "xyz", "xz+turn", "xyz+turn"}))
      ->type_name("AXES")
      ->group(group);
  command
      .add_option("--root-smoothing", edits.smoothing,
                  "seconds over which the pelvis' sway is no travel; 0: all that it moves is")
      ->check(numberIn(0, 60))
      ->type_name("SECONDS")
      ->capture_default_str()
      ->group(group);
  command
      .add_option_function<double>(
          "--tolerance", [this](double millimetres) { edits.tolerance = millimetres * kMillimetre; },
          "fewest keys that move nothing of the surface by more than so many millimetres")
      ->check(numberIn(1e-6, 1e9))
      ->type_name("MM")
      ->group(group);
  command_ = &command;
}

void ClipArguments::check() const {
  for (const char* option : {"--root-motion", "--root-smoothing"}) {
    if (command_->count(option) > 0 && !edits.inPlace && !edits.rootJoint) {
      throw CLI::ValidationError(option, "says what --in-place or --root-joint takes");
    }
  }
}

void ClipArguments::tell(const std::vector<ClipEditReport>& reports, const Account& account) const {
  for (const ClipEditReport& report : reports) {
    if (edits.loop) {
      account.line(
          report.loop ? fmt::format("{}: loops from {:.3f} to {:.3f} s, the ends {:.2g} apart; joined, which moves "
                                    "joints by {:.2g} at most",
                                    report.clip, report.loop->begin, report.loop->end, report.gap, report.largestChange)
                      : fmt::format("{}: no loop found, left as it is", report.clip));
    }
    if (edits.tolerance) {
      account.line(fmt::format("{}: {} of {} keys, at most {:.3g} mm off", report.clip, report.keysAfter,
                               report.keysBefore, report.largestError / kMillimetre));
    }
  }
}

}  // namespace limber::cli
