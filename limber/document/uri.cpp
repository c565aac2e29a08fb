#include "limber/document/uri.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "limber/core/error.h"
#include "limber/core/text/names.h"

namespace limber {

namespace {

constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t kNoDigit = 255;

constexpr std::array<std::uint8_t, 256> digitTable() {
  std::array<std::uint8_t, 256> table{};
  for (std::uint8_t& digit : table) digit = kNoDigit;
  for (std::size_t i = 0; i < kAlphabet.size(); ++i) {
    table[static_cast<unsigned char>(kAlphabet[i])] = static_cast<std::uint8_t>(i);
  }
  return table;
}
constexpr std::array<std::uint8_t, 256> kDigits = digitTable();

Bytes decodeBase64(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  Bytes bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int bitCount = 0;
  for (const char c : text) {
    const std::uint8_t digit = kDigits[static_cast<unsigned char>(c)];
    if (digit == kNoDigit) throw Error(ErrorCode::kBadData, "data URI is not valid base64");
    bits = bits << 6 | digit;
    bitCount += 6;
    if (bitCount >= 8) {
      bitCount -= 8;
      bytes.push_back(static_cast<std::uint8_t>(bits >> bitCount));
    }
  }
  if (bitCount == 6) throw Error(ErrorCode::kBadData, "data URI is cut off inside its base64");
  return bytes;
}

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// A '%' that no two hexadecimal digits follow is kept as it is: exporters write plain file names too.
std::string percentDecode(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && hexDigit(text[i + 1]) >= 0 && hexDigit(text[i + 2]) >= 0) {
      result += static_cast<char>(hexDigit(text[i + 1]) * 16 + hexDigit(text[i + 2]));
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

bool startsLikeData(std::string_view uri) {
  constexpr std::string_view kScheme = "data:";
  return lowerCase(uri.substr(0, kScheme.size())) == kScheme;
}

}  // namespace

bool isDataUri(std::string_view uri) {
  return startsLikeData(uri);
}

DataUri decodeDataUri(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) throw Error(ErrorCode::kBadData, "data URI has no comma before its data");
  const std::string_view header = uri.substr(0, comma);
  constexpr std::string_view kBase64 = ";base64";
  if (header.size() < kBase64.size() || header.substr(header.size() - kBase64.size()) != kBase64) {
    throw Error(ErrorCode::kBadData, "data URI is not base64");
  }
  return {std::string(uri.substr(0, comma + 1)), decodeBase64(uri.substr(comma + 1))};
}

std::string encodeBase64(ByteSpan bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = std::uint32_t{bytes[i]} << 16;
    if (left > 1) bits |= std::uint32_t{bytes[i + 1]} << 8;
    if (left > 2) bits |= bytes[i + 2];
    text += kAlphabet[bits >> 18];
    text += kAlphabet[bits >> 12 & 63];
    text += left > 1 ? kAlphabet[bits >> 6 & 63] : '=';
    text += left > 2 ? kAlphabet[bits & 63] : '=';
  }
  return text;
}

void checkLocalPath(const std::string& path) {
  const auto refuse = [&](const char* why) {
    throw Error(ErrorCode::kBadData, "refers to \"" + path.substr(0, 200) + "\", " + why, {},
                "put the file beside the model and name it by a relative path");
  };
  if (path.empty()) refuse("which is no file");
  if (std::any_of(path.begin(), path.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; })) {
    refuse("which holds a control character");
  }
  // A colon anywhere may be a scheme, a drive or an alternate stream.
  if (path.find(':') != std::string::npos) refuse("which is not a relative path");
  if (path[0] == '/' || path[0] == '\\') refuse("which is not a relative path");
  std::size_t begin = 0;
  while (begin <= path.size()) {
    const std::size_t end = std::min(path.find_first_of("/\\", begin), path.size());
    if (path.compare(begin, end - begin, "..") == 0) refuse("which leaves the model's folder");
    begin = end + 1;
  }
}

std::string localPath(std::string_view uri) {
  std::string path = percentDecode(uri);
  checkLocalPath(path);
  return path;
}

std::string percentEncode(std::string_view path) {
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/()!,+'@$&;=*";
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string uri;
  for (const char c : path) {
    if (kPlain.find(c) != std::string_view::npos) {
      uri += c;
    } else {
      uri += '%';
      uri += kHex[static_cast<unsigned char>(c) >> 4];
      uri += kHex[static_cast<unsigned char>(c) & 15];
    }
  }
  return uri;
}

}  // namespace limber
