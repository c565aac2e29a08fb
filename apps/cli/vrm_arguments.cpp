#include "vrm_arguments.h"

#include <CLI/CLI.hpp>

namespace limber::cli {

void VrmArguments::addTo(CLI::App& command) {
  const char* group = "What a VRM says of itself";
  command.add_option("--vrm-name", meta.name, "the model's name (default: the file's)")
      ->type_name("NAME")
      ->group(group);
  command.add_option("--vrm-author", meta.authors, "who made it; may be given several times")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->group(group);
  command.add_option("--vrm-version", meta.version, "the model's version")->type_name("TEXT")->group(group);
  command.add_option("--vrm-copyright", meta.copyright, "who has the rights")->type_name("TEXT")->group(group);
  command.add_option("--vrm-contact", meta.contact, "whom to ask")->type_name("TEXT")->group(group);
  command.add_option("--vrm-license", meta.license, "where a licence of its own is to be read")
      ->type_name("URL")
      ->group(group);
  command
      .add_option("--vrm-allow", meta.allowed,
                  "what others may do; all else is denied. May be given several times; not for a VRM, which says so "
                  "itself")
      ->check(CLI::IsMember(vrmPermissions()))
      ->type_name("WHAT")
      ->allow_extra_args(false)
      ->group(group);
}

}  // namespace limber::cli
