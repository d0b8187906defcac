#include "vins_core/run_tool.h"

#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace po = boost::program_options;

namespace vins {
namespace {

/// What a stream is given in this object's life.
class Captured {
 public:
  explicit Captured(std::ostream* stream)
      : stream_(stream), before_(stream->rdbuf(text_.rdbuf())) {}
  ~Captured() { stream_->rdbuf(before_); }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;

  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::ostream* stream_;
  std::streambuf* before_;
};

struct Outcome {
  int exit_code = -1;
  std::string out, err;
  bool ran = false;
};

ToolDescription copyTool() {
  po::options_description options;
  auto add = options.add_options();
  add("from", po::value<std::string>()->required(), "what to copy");
  add("to", po::value<std::vector<std::string>>(), "where to");
  add("times,n", po::value<int>()->default_value(1), "how often");
  return {"copy",
          "Copies.\nUsage: copy FROM TO ...\n",
          options,
          {{"from", 1}, {"to", -1}},
          "Exit code: 0 copied.\n"};
}

Outcome run(std::vector<std::string> arguments,
            const std::function<ToolExit(const po::variables_map&)>& body,
            const ToolDescription& tool = copyTool()) {
  arguments.insert(arguments.begin(), "/some/where/copy");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  Outcome outcome;
  const Captured out(&std::cout), err(&std::cerr);
  outcome.exit_code = runTool(static_cast<int>(argv.size()), argv.data(), tool,
                              [&](const po::variables_map& values) {
                                outcome.ran = true;
                                return body(values);
                              });
  outcome.out = out.text();
  outcome.err = err.text();
  return outcome;
}

ToolExit done(const po::variables_map&) { return ToolExit::kDone; }

TEST(RunTool, HandsOptionsToTheBodyByNameAndByPlace) {
  const auto body = [](const po::variables_map& values) {
    EXPECT_EQ(values["from"].as<std::string>(), "a");
    EXPECT_EQ(values["to"].as<std::vector<std::string>>(), (std::vector<std::string>{"b", "c"}));
    EXPECT_EQ(values["times"].as<int>(), 3);
    return ToolExit::kDone;
  };
  const Outcome outcome = run({"a", "-n", "3", "b", "c"}, body);
  EXPECT_TRUE(outcome.ran);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
}

TEST(RunTool, TheBodysExitCodeIsTheTools) {
  EXPECT_EQ(run({"a"}, [](const auto&) { return ToolExit::kFellShort; }).exit_code, 2);
  EXPECT_EQ(run({"a"}, [](const auto&) { return ToolExit::kInterrupted; }).exit_code, 130);
}

TEST(RunTool, HelpPrintsTheDescriptionAndRunsNothing) {
  const Outcome outcome = run({"--help"}, done);
  EXPECT_FALSE(outcome.ran) << "though a required option is missing";
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  // In this order; how the options are laid out is Boost's affair.
  std::size_t at = 0;
  for (const char* part :
       {"Copies.\nUsage: copy FROM TO ...\n\nOptions:\n", "--help", "print this", "--from arg",
        "--to arg", "--times ] arg (=1)", "how often\n\nExit code"}) {
    at = outcome.out.find(part, at);
    ASSERT_NE(at, std::string::npos) << part << " in\n" << outcome.out;
  }
  EXPECT_EQ(outcome.out.rfind("Copies.", 0), 0u);
}

TEST(RunTool, BadOptionsAreToldWithAHintAtTheHelp) {
  const struct {
    std::vector<std::string> arguments;
    std::string word;
  } cases[] = {
      {{}, "the option '--from' is required"},
      {{"a", "--speed", "2"}, "unrecognised option '--speed'"},
      {{"a", "-n", "many"}, "the argument ('many')"},
  };
  for (const auto& c : cases) {
    const Outcome outcome = run(c.arguments, done);
    EXPECT_FALSE(outcome.ran);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(outcome.err.rfind("copy: ", 0), 0u) << outcome.err;
    EXPECT_NE(outcome.err.find(c.word), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("; see --help\n"), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
}

TEST(RunTool, WhatTheBodyThrowsIsToldInOneLine) {
  const Outcome outcome =
      run({"a"}, [](const auto&) -> ToolExit { throw InputError("a: cannot be opened"); });
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.err, "copy: a: cannot be opened\n");
}

}  // namespace
}  // namespace vins
