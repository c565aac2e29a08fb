#include "certificate.h"

#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>

#include <array>
#include <cstdlib>
#include <ctime>
#include <optional>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/file/file.h"

namespace limber::cli {

namespace {

namespace fs = std::filesystem;

constexpr long kDay = 24 * 60 * 60;        // seconds
constexpr long kValidity = 365 * kDay;     // iOS takes up to 825 days
constexpr long kEarlier = kDay;            // a phone's clock may be behind
constexpr std::size_t kMaxBytes = 10'000;  // of the file: far more than it has

void check(bool done, const char* what) {
  if (!done) throw Error(ErrorCode::kUnsupported, fmt::format("the certificate cannot be made: {}", what));
}

using Bio = std::unique_ptr<BIO, decltype(&BIO_free)>;

std::string fingerprintOf(const X509& x509) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned size = 0;
  check(X509_digest(&x509, EVP_sha256(), digest.data(), &size) == 1, "no fingerprint");
  std::string text;
  for (unsigned i = 0; i < size; ++i) text += fmt::format("{}{:02X}", i == 0 ? "" : ":", digest[i]);
  return text;
}

Certificate certificateOf(X509* x509, EVP_PKEY* key, bool is_new) {
  Certificate certificate;
  certificate.x509 = {x509, X509_free};
  certificate.key = {key, EVP_PKEY_free};
  certificate.is_new = is_new;
  return certificate;
}

bool serves(const Certificate& certificate, const std::string& address) {
  if (!certificate.x509 || !certificate.key) return false;
  X509* x509 = certificate.x509.get();
  std::time_t now = std::time(nullptr), tomorrow = now + kDay;
  return X509_check_private_key(x509, certificate.key.get()) == 1 &&
         X509_cmp_time(X509_get0_notBefore(x509), &now) < 0 && X509_cmp_time(X509_get0_notAfter(x509), &tomorrow) > 0 &&
         X509_check_ip_asc(x509, address.c_str(), 0) == 1;
}

bool isForItsUserAlone(const fs::path& path) {
  struct stat info;
  return stat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode) && (info.st_mode & 0777) == 0600;
}

// Nothing where it is missing, damaged, or may have been read by others.
std::optional<Certificate> readCertificate(const fs::path& path) {
  if (!isForItsUserAlone(path)) return std::nullopt;
  Bytes bytes;
  try {
    bytes = readFile(path);
  } catch (const Error&) {
    return std::nullopt;
  }
  if (bytes.size() > kMaxBytes) return std::nullopt;
  const Bio source(BIO_new_mem_buf(bytes.data(), static_cast<int>(bytes.size())), BIO_free);
  if (!source) return std::nullopt;
  EVP_PKEY* key = PEM_read_bio_PrivateKey(source.get(), nullptr, nullptr, nullptr);
  return certificateOf(PEM_read_bio_X509(source.get(), nullptr, nullptr, nullptr), key, false);
}

void addExtension(X509* x509, int kind, const std::string& value) {
  const std::unique_ptr<X509_EXTENSION, decltype(&X509_EXTENSION_free)> extension(
      X509V3_EXT_conf_nid(nullptr, nullptr, kind, value.c_str()), X509_EXTENSION_free);
  check(extension && X509_add_ext(x509, extension.get(), -1) == 1, value.c_str());
}

Certificate makeCertificate(const std::string& address, const std::vector<std::string>& others) {
  Certificate made = certificateOf(X509_new(), EVP_EC_gen("P-256"), true);
  X509* x509 = made.x509.get();
  check(x509 && made.key, "no key");
  std::array<unsigned char, 16> number;
  check(RAND_bytes(number.data(), number.size()) == 1, "no random numbers");
  number[0] &= 0x7f;  // a serial number is positive
  const std::unique_ptr<BIGNUM, decltype(&BN_free)> serial(BN_bin2bn(number.data(), number.size(), nullptr), BN_free);
  check(serial && BN_to_ASN1_INTEGER(serial.get(), X509_get_serialNumber(x509)), "no serial number");

  X509_NAME* name = X509_get_subject_name(x509);
  const auto* common = reinterpret_cast<const unsigned char*>("limber studio");
  check(X509_set_version(x509, X509_VERSION_3) == 1 && X509_gmtime_adj(X509_getm_notBefore(x509), -kEarlier) &&
            X509_gmtime_adj(X509_getm_notAfter(x509), kValidity) && X509_set_pubkey(x509, made.key.get()) == 1 &&
            X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC, common, -1, -1, 0) == 1 &&
            X509_set_issuer_name(x509, name) == 1,
        "its fields");
  std::string names = "IP:" + address;
  for (const std::string& other : others) {
    if (other != address) names += ",IP:" + other;
  }
  addExtension(x509, NID_subject_alt_name, names);
  addExtension(x509, NID_basic_constraints, "critical,CA:FALSE");
  addExtension(x509, NID_key_usage, "critical,digitalSignature");
  addExtension(x509, NID_ext_key_usage, "serverAuth");
  check(X509_sign(x509, made.key.get(), EVP_sha256()) > 0, "its signature");
  return made;
}

std::string asPem(const Certificate& certificate) {
  const Bio text(BIO_new(BIO_s_mem()), BIO_free);
  check(text &&
            PEM_write_bio_PrivateKey(text.get(), certificate.key.get(), nullptr, nullptr, 0, nullptr, nullptr) == 1 &&
            PEM_write_bio_X509(text.get(), certificate.x509.get()) == 1,
        "its text");
  char* bytes = nullptr;
  const long size = BIO_get_mem_data(text.get(), &bytes);
  return {bytes, static_cast<std::size_t>(size)};
}

// New files and folders are this user's alone.
class PrivateFiles {
 public:
  PrivateFiles() : before_(umask(0077)) {}
  ~PrivateFiles() { umask(before_); }
  PrivateFiles(const PrivateFiles&) = delete;
  PrivateFiles& operator=(const PrivateFiles&) = delete;

 private:
  mode_t before_;
};

void keep(const Certificate& certificate, const fs::path& path) {
  const PrivateFiles while_writing;
  try {
    fs::create_directories(path.parent_path());
    writeFile(path, asBytes(asPem(certificate)));
  } catch (const fs::filesystem_error& error) {
    throw Error(ErrorCode::kFile, fmt::format("the certificate cannot be kept: {}", error.code().message()),
                path.parent_path().string(), "name a folder of yours in XDG_DATA_HOME");
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("the certificate {}", error.message()), path.string(),
                "name a folder of yours in XDG_DATA_HOME");
  }
}

}  // namespace

fs::path certificatePath() {
  const char* data = std::getenv("XDG_DATA_HOME");
  if (data && fs::path(data).is_absolute()) return fs::path(data) / "limber" / "studio.pem";
  const char* home = std::getenv("HOME");
  if (!home || !fs::path(home).is_absolute()) {
    throw Error(ErrorCode::kFile, "there is no folder to keep the certificate in", {},
                "name a folder of yours in XDG_DATA_HOME");
  }
  return fs::path(home) / ".local" / "share" / "limber" / "studio.pem";
}

Certificate certificateAt(const fs::path& path, const std::string& address, const std::vector<std::string>& others) {
  Certificate certificate = readCertificate(path).value_or(Certificate());
  if (!serves(certificate, address)) {
    certificate = makeCertificate(address, others);
    keep(certificate, path);
  }
  certificate.fingerprint = fingerprintOf(*certificate.x509);
  return certificate;
}

}  // namespace limber::cli
