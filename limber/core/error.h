// What is thrown when something cannot be done, and what is collected when it can be done only after a repair.
#pragma once

#include <cstddef>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

namespace limber {

enum class ErrorCode {
  kBadArgument,  // a call or a command-line option that makes no sense
  kFile,         // cannot be opened, read or written
  kBadData,      // the file's content breaks its format
  kUnsupported,  // well formed, but not something limber can do
  kLimit,        // larger than limber's 32-bit indices or the memory allowed for a file of that size
  kCancelled,    // the user asked to stop
};

std::string_view errorCodeName(ErrorCode code);

// The one exception type of limber.
//   message  what went wrong: "accessor has 12 elements but its buffer view holds 9"
//   where    file and element, may be empty: "fox.glb: accessors[3]"
//   remedy   what the user can do, may be empty: "export the model again"
// what() is all of it on one line: "fox.glb: accessors[3]: accessor has ... (export the model again)".
class Error : public std::exception {
 public:
  Error(ErrorCode code, std::string message, std::string where = {}, std::string remedy = {});

  ErrorCode code() const { return code_; }
  const std::string& message() const { return message_; }
  const std::string& where() const { return where_; }
  const std::string& remedy() const { return remedy_; }
  const char* what() const noexcept override { return line_.c_str(); }

  // The same error, said of an element inside `outer` (usually the file's name): where becomes "outer: where", unless
  // it begins so already.
  Error within(std::string_view outer) const;

 private:
  ErrorCode code_;
  std::string message_, where_, remedy_, line_;
};

// A repair or a simplification that the user should know of. Warnings of one kind are counted, not repeated.
struct Warning {
  std::string kind;     // stable and short: "degenerate-triangles"
  std::string message;  // "degenerate triangles left out"
  std::string where;    // where it was first met, may be empty
  std::size_t count = 0;
};

// The message, and how often where that was more than once: "degenerate triangles left out (12)".
std::string warningText(const Warning& warning);

class Warnings {
 public:
  // Adds `count` to the warning of that kind; `message` and `where` are those of the first call.
  void add(std::string_view kind, std::string_view message, std::string_view where = {}, std::size_t count = 1);
  void append(const Warnings& other);
  const std::vector<Warning>& items() const { return items_; }
  bool empty() const { return items_.empty(); }

 private:
  std::vector<Warning> items_;  // in the order in which they were first met
};

}  // namespace limber
