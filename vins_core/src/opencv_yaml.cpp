#include "opencv_yaml.h"

#include <cctype>
#include <cstdlib>
#include <sstream>

namespace vins {
namespace {

/// OpenCV writes "%YAML:1.0" where YAML wants "%YAML 1.0"; as a comment it says the same.
std::string withoutDirective(const std::string& text) {
  const std::size_t start = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (start == std::string::npos || text.compare(start, 6, "%YAML:") != 0) return text;
  std::string plain = text;
  plain[start] = '#';
  return plain;
}

bool isSpace(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

bool isIdentifier(const std::string& word) {
  if (word.empty() || std::isdigit(static_cast<unsigned char>(word[0])) != 0) return false;
  for (const char c : word) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_') return false;
  }
  return true;
}

bool isNumber(const std::string& word) {
  char* end = nullptr;
  std::strtod(word.c_str(), &end);
  return !word.empty() && *end == '\0';
}

/// Copies text character by character and inserts the spaces that YAML wants. Knows as much of
/// YAML's syntax as it takes to tell keys from values: quotes, comments, brackets.
class SpaceInserter {
 public:
  explicit SpaceInserter(std::vector<std::string>* repairs) : repairs_(repairs) {}

  std::string repaired(const std::string& line, int number) {
    line_number_ = number;
    out_.clear();
    word_.clear();
    may_be_key_ = true;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (quote_ == 0 && line[i] == '#' && startsComment()) {
        return out_ + line.substr(i);
      }
      take(line[i], i + 1 < line.size() ? line[i + 1] : '\n');
    }
    return out_;
  }

 private:
  bool startsComment() {
    if (out_.empty() || isSpace(out_.back())) return true;
    const bool follows_value = std::string("\"']}").find(out_.back()) != std::string::npos;
    if (!follows_value && !isNumber(word_)) return false;  // OpenCV keeps "a#b" as it is
    report("'" + word_ + "#' has no space before the comment");
    out_ += ' ';
    return true;
  }

  void take(char c, char next) {
    out_ += c;
    if (quote_ != 0) {
      takeQuoted(c);
    } else if (word_.empty() && (c == '"' || c == '\'')) {
      quote_ = c;
    } else if ((c == '{' || c == '[') && word_.empty()) {
      brackets_ += c;
      begin(c == '{');
    } else if ((c == '}' || c == ']') && !brackets_.empty()) {
      brackets_.pop_back();
      begin(false);
    } else if (c == ',' && !brackets_.empty()) {
      begin(brackets_.back() == '{');
    } else if (c == ':' && may_be_key_ && isIdentifier(word_)) {
      endKey(next);
    } else if (!isSpace(c) && !(c == '-' && word_.empty() && isSpace(next))) {
      word_ += c;
    }
  }

  void takeQuoted(char c) {
    const bool is_escaped = escaped_;
    escaped_ = quote_ == '"' && c == '\\' && !is_escaped;
    if (c == quote_ && !is_escaped) quote_ = 0;
  }

  void endKey(char next) {
    if (!isSpace(next)) {
      report("'" + word_ + ":' has no space after the colon");
      out_ += ' ';
    }
    begin(false);
  }

  void begin(bool may_be_key) {
    word_.clear();
    may_be_key_ = may_be_key;
  }

  void report(const std::string& what) {
    repairs_->push_back("line " + std::to_string(line_number_) + ": " + what);
  }

  std::vector<std::string>* repairs_;
  int line_number_ = 0;
  std::string out_, word_;  ///< of the line; of the key or value that is being read
  std::string brackets_;    ///< that are open, also from lines before
  char quote_ = 0;          ///< that is open
  bool escaped_ = false;
  bool may_be_key_ = true;
};

}  // namespace

std::string standardYaml(const std::string& text, std::vector<std::string>* repairs) {
  SpaceInserter inserter(repairs);
  std::istringstream in(withoutDirective(text));
  std::string standard;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    standard += inserter.repaired(line, ++number) + "\n";
  }
  return standard;
}

}  // namespace vins
