// SHA-256 (FIPS 180-4), by which kept results are found again.
#pragma once

#include <memory>
#include <string>

#include "limber/core/file/file.h"

struct evp_md_ctx_st;

namespace limber {

// By OpenSSL.
class Sha256 {
 public:
  Sha256();
  void add(ByteSpan bytes);
  // Of all that was added, as 64 hexadecimal digits; nothing may be added after.
  std::string hex();

 private:
  std::unique_ptr<evp_md_ctx_st, void (*)(evp_md_ctx_st*)> state_;
};

std::string sha256OfFile(const std::filesystem::path& path);

}  // namespace limber
