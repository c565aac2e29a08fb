// limber studio: the page that rigs and poses, out of the program.
#include <memory>

#include <fmt/format.h>

#include "command.h"
#include "studio_server.h"

namespace limber::cli {

void addStudioCommand(CLI::App& program) {
  auto port = std::make_shared<int>(8080);
  CLI::App* command = program.add_subcommand("studio", "Rig, pose and animate in the browser");
  command->add_option("--port", *port, "where it listens; 0 takes a free one")
      ->check(CLI::Range(0, 65535).description(""))
      ->type_name("N")
      ->capture_default_str();
  command->footer(
      "The page is served on this machine's own address (127.0.0.1) until Ctrl+C; what is opened in it stays on the "
      "machine.\n\nExample:\n  limber studio --port 0");
  command->callback([port] {
    serveStudio(*port, [](const std::string& address) {
      fmt::print("The studio is on {} until Ctrl+C\n", address);
      flushOutput();
    });
  });
}

}  // namespace limber::cli
