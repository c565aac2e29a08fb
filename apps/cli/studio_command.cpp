// limber studio: the page that rigs and poses, out of the program.
#include <unistd.h>

#include <memory>
#include <optional>

#include <fmt/format.h>

#include "command.h"
#include "limber/core/text/printable.h"
#include "studio/qr_code.h"
#include "studio/server.h"

namespace limber::cli {

namespace {

void tellThisMachine(const ServeEvents::Listening& now) {
  fmt::print("The studio is on {} until Ctrl+C\n", now.address);
  if (now.live) {
    fmt::print("Live motion: VMC by UDP to 127.0.0.1:{}, BVH by TCP to 127.0.0.1:{}\n", now.live->vmc, now.live->bvh);
  }
  flushOutput();
}

void tellNetwork(const ServeEvents::Listening& now, int devices) {
  fmt::print("The studio is on {} until Ctrl+C\n\n", now.address);
  fmt::print("{}\n", halfBlocks(qrCode(now.address), kQrMargin, isatty(STDOUT_FILENO) == 1));
  fmt::print(
      "Other machines in this network can reach the port. They get the files of the studio's page, no others,\n");
  fmt::print("and only {} this address first. What is opened in the page stays on the device.\n",
             devices == 1 ? "the one device that opens" : fmt::format("the {} devices that open", devices));
  fmt::print(
      "The browser warns of {} certificate, which nobody vouches for. Go on where it has the SHA-256\nfingerprint {}\n",
      now.is_certificate_new ? "a new" : "the", now.fingerprint);
  flushOutput();
}

void tellOfDevice(const std::string& from, int device, int devices) {
  fmt::print("{} was let in ({} of {})\n", from, device, devices);
  flushOutput();
}

void tellOfSender(const std::string& what) {
  fmt::print(stderr, "live motion: {}\n", printable(what));
}

}  // namespace

void addStudioCommand(CLI::App& program) {
  const auto options = std::make_shared<ServeOptions>();
  const auto address = std::make_shared<std::string>();
  const auto live = std::make_shared<LivePorts>();
  CLI::App* command = program.add_subcommand("studio", "Rig, pose and animate in the browser");
  command->add_option("--port", options->port, "where it listens; 0 takes a free one")
      ->check(CLI::Range(0, 65535).description(""))
      ->type_name("N")
      ->capture_default_str();
  CLI::Option* host = command
                          ->add_option("--host", *address,
                                       "serves a phone in the same network, by https; where this machine has several\n"
                                       "addresses, on that one")
                          ->expected(0, 1)
                          ->type_name("[ADDRESS]");
  command->add_option("--devices", options->devices, "how many devices the address of --host lets in")
      ->check(CLI::Range(1, 1000).description(""))
      ->type_name("N")
      ->capture_default_str()
      ->needs(host);
  const auto wantsLive = std::make_shared<bool>(false);
  CLI::Option* isLive = command
                            ->add_flag("--live", *wantsLive,
                                       "puts motion that other programs of this machine send on the character: VMC's\n"
                                       "packets, or a BVH line by line (docs/motion-files.md)")
                            ->excludes(host);
  const auto addPort = [&](const char* name, int& port, const char* about) {
    command->add_option(name, port, about)
        ->check(CLI::Range(0, 65535).description(""))
        ->type_name("N")
        ->capture_default_str()
        ->needs(isLive);
  };
  addPort("--vmc-port", live->vmc, "where --live gets VMC by UDP; 0 takes a free one");
  addPort("--bvh-port", live->bvh, "where --live gets BVH by TCP; 0 takes a free one");
  command->footer(
      "The page is served on this machine's own address (127.0.0.1) until Ctrl+C; what is opened in it stays on the "
      "machine.\n\n--host shows a QR code for the phone's camera. The address in it opens the page on one device and "
      "is used up\nthen; the certificate is made on first use and kept in ~/.local/share/limber.\n\nExamples:\n"
      "  limber studio --port 0\n  limber studio --host\n  limber studio --host 192.168.1.20 --devices 25\n  limber "
      "studio --live");
  command->callback([options, address, host, live, wantsLive] {
    if (*wantsLive) options->live = *live;
    if (host->count() == 0) return serveStudio(*options, {tellThisMachine, nullptr, tellOfSender});
    options->host = *address;
    const int devices = options->devices;
    serveStudio(*options, {[devices](const ServeEvents::Listening& now) { tellNetwork(now, devices); },
                           [devices](const std::string& from, int device) { tellOfDevice(from, device, devices); }});
  });
}

}  // namespace limber::cli
