#include "limber/jobs/sha256.h"

#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openssl/evp.h>

#include "limber/core/error.h"

namespace limber {

namespace {

void check(int succeeded) {
  if (succeeded != 1) throw Error(ErrorCode::kUnsupported, "OpenSSL computes no SHA-256 here");
}

}  // namespace

Sha256::Sha256() : state_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
  check(EVP_DigestInit_ex(state_.get(), EVP_sha256(), nullptr));
}

void Sha256::add(ByteSpan bytes) {
  check(EVP_DigestUpdate(state_.get(), bytes.data(), bytes.size()));
}

std::string Sha256::hex() {
  std::array<unsigned char, 32> digest;
  check(EVP_DigestFinal_ex(state_.get(), digest.data(), nullptr));
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

std::string sha256OfFile(const std::filesystem::path& path) {
  Sha256 hash;
  readFileInPieces(path, [&](ByteSpan piece) { hash.add(piece); });
  return hash.hex();
}

}  // namespace limber
