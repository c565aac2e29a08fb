#include "limber/study/command_words.h"

#include "limber/document/utf8.h"
#include "limber/jobs/last_line.h"

namespace limber {

std::string commandWords(std::string_view text) {
  constexpr std::size_t kMax = 1000;  // bytes
  const std::string line = lastLine(text, kMax);
  return validUtf8(line.starts_with(kSpeaker) ? std::string_view(line).substr(kSpeaker.size()) : line);
}

std::string replaced(std::string text, std::string_view name, std::string_view by) {
  for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos; at += by.size()) {
    text.replace(at, name.size(), by);
  }
  return text;
}

}  // namespace limber
