// The scripts of limber completion, as shells run them.
#include <cstdio>
#include <memory>
#include <string>

#include "testing/cli_fixture.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// What a shell prints and whether it was content; the script is the file "script" of the folder.
std::string said(const fs::path& folder, const std::string& command) {
  const std::string whole = "cd '" + folder.string() + "' && " + command + " 2>&1";
  const std::unique_ptr<FILE, int (*)(FILE*)> shell(popen(whole.c_str(), "r"), pclose);
  std::string text;
  for (int c = 0; (c = fgetc(shell.get())) != EOF;) text += static_cast<char>(c);
  return text;
}

bool isThere(const std::string& shell) {
  return std::system(("command -v " + shell + " >/dev/null").c_str()) == 0;
}

TEST_F(Cli, BashCompletesCommandsAndOptions) {
  put("script", run({"completion", "bash"}).out);
  const auto completed = [&](const std::string& words, int at) {
    return said(folder_, "bash -c '. ./script; COMP_WORDS=(" + words + "); COMP_CWORD=" + std::to_string(at) +
                             "; _limber; echo \"[${COMPREPLY[*]}]\"'");
  };
  EXPECT_EQ(completed("limber stud", 1), "[study studio]\n");
  EXPECT_EQ(completed("limber evaluate mod", 2), "[model]\n");
  EXPECT_EQ(completed("limber rig a.glb --keep", 3), "[--keep-skeleton]\n");
  EXPECT_EQ(completed("limber rig a.glb --source", 3), "[]\n");  // an option of another command
  EXPECT_THAT(completed("limber evaluate model --j", 3), HasSubstr("--json"));
}

TEST_F(Cli, OtherShellsTakeTheirScripts) {
  const std::string fish = run({"completion", "fish"}).out, zsh = run({"completion", "zsh"}).out;
  EXPECT_THAT(fish, AllOf(HasSubstr("-l keep-skeleton"), HasSubstr("limber\\'s"), Not(HasSubstr("limber's"))));
  EXPECT_THAT(zsh, AllOf(HasSubstr("#compdef limber"), HasSubstr("'--keep-skeleton:"), HasSubstr("limber'\\''s")));
  if (isThere("fish")) {
    put("script", fish);
    EXPECT_THAT(said(folder_, "fish -c 'source script; complete -C \"limber evaluate mod\"'"), HasSubstr("model\t"));
  }
  if (isThere("zsh")) {
    put("script", zsh);
    EXPECT_EQ(said(folder_, "zsh -n script"), "");
  }
}

TEST_F(Cli, CompletionOfAShellThatIsNotKnown) {
  expectOneLine(run({"completion", "cmd"}), 2);
}

}  // namespace
}  // namespace limber
