// A certificate of this machine's own for https in a local network, where no authority gives one.
#pragma once

#include <openssl/types.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace limber::cli {

struct Certificate {
  std::shared_ptr<X509> x509;
  std::shared_ptr<EVP_PKEY> key;
  std::string fingerprint;  // SHA-256, as browsers show it: "3F:A0:..."
  bool is_new = false;
};

// $XDG_DATA_HOME/limber/studio.pem, or below ~/.local/share. Throws Error kFile where neither variable is set.
std::filesystem::path certificatePath();

// The one kept at `path`, key and certificate in one file that only its user may read (mode 0600); made where there is
// none, and made anew where it does not serve: it does not name `address` (numeric), others could read its key, it is
// damaged, or has less than a day left. A new one names `others` as well, so that it serves there, too. EC P-256,
// signed by itself, for a year, and no authority for others: who trusts it trusts this machine at these addresses and
// nothing else. Makes missing folders. Throws Error kFile where it cannot be written.
Certificate certificateAt(const std::filesystem::path& path, const std::string& address,
                          const std::vector<std::string>& others);

}  // namespace limber::cli
