#pragma once

#include <initializer_list>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace vins {

/// Numbers from `min` to `max`, both allowed.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

/// A YAML file of parameters, read strictly. Takes OpenCV's form ("%YAML:1.0", !!opencv-matrix) as
/// VINS-Mono's configuration files have it, and plain YAML as Kalibr writes it. Where OpenCV's
/// reader is more lenient than YAML it is followed: "key:value", "0.08# noise", a key given twice
/// (the first counts), a key without a value (as if it were absent); remarks() tells what was met
/// of this.
///
/// Every getter throws InputError naming file, line, key, what was found and what is allowed; a
/// key that is absent where it is needed names a similar one that nothing asked for. The getters
/// remember which keys were asked for, so that warnings() can name the others.
class Parameters {
 public:
  /// Reads the file at `path`. Throws where it cannot be read, is no YAML (with line and column) or
  /// is no map at its top.
  static Parameters load(const std::string& path);

  /// The same for text; `name` stands for the file in messages.
  static Parameters parse(const std::string& text, const std::string& name);

  /// The file's name, and the path of keys to this section: "camchain.yaml" or "camchain.yaml:
  /// cam0".
  const std::string& name() const { return name_; }

  /// The key is there and has a value.
  bool has(const std::string& key) const;
  std::vector<std::string> keys() const;

  /// A finite number within `allowed`.
  double number(const std::string& key, const Range& allowed = {}) const;
  double numberOr(const std::string& key, double fallback, const Range& allowed = {}) const;

  /// A whole number within `allowed`.
  int integer(const std::string& key, const Range& allowed = {}) const;
  int integerOr(const std::string& key, int fallback, const Range& allowed = {}) const;

  /// 0 or 1 in any form of a number, also true/false, yes/no, on/off.
  bool flag(const std::string& key) const;
  bool flagOr(const std::string& key, bool fallback) const;

  /// Text; one of `allowed`, letter case aside, where there are any (the spelling of `allowed` is
  /// returned).
  std::string text(const std::string& key, const std::vector<std::string>& allowed = {}) const;
  std::string textOr(const std::string& key, const std::string& fallback,
                     const std::vector<std::string>& allowed = {}) const;

  /// A sequence of finite numbers, of one of the lengths `counts` (any length where it is empty).
  std::vector<double> numbers(const std::string& key,
                              std::initializer_list<std::size_t> counts = {}) const;

  /// A matrix of this size: an !!opencv-matrix, or a sequence of rows.
  Eigen::MatrixXd matrix(const std::string& key, int rows, int cols) const;

  /// The map at `key`, as parameters of their own. Asked for again it is the same section, with its
  /// memory of what was asked for.
  Parameters section(const std::string& key) const;

  /// The value of the key is a map.
  bool isSection(const std::string& key) const;

  /// Remembers keys that others read from the same map, as if a getter had asked for them.
  void know(const std::vector<std::string>& keys) const;

  /// Keys in this map that no getter asked for.
  std::vector<std::string> unknownKeys() const;

  /// One text for each key in this map that no getter asked for, with its line and a likely
  /// meaning: "rig.yaml:12: unknown key 'max_cn' is ignored; did you mean 'max_cnt'?".
  std::vector<std::string> warnings() const;

  /// Notes something about a value that its reader has changed or chosen, "FILE:LINE: TEXT", for
  /// remarks(). Without the line where the key is absent.
  void remark(const std::string& key, const std::string& text) const;

  /// What a user should hear of the whole file, all its sections included: in one line how the text
  /// was mended so that it can be read, then a line for each remark().
  std::vector<std::string> remarks() const;

  /// Throws InputError: "FILE:LINE: key 'KEY': found FOUND; allowed: ALLOWED". For checks that
  /// go beyond a single value.
  [[noreturn]] void fail(const std::string& key, const std::string& found,
                         const std::string& allowed) const;

 private:
  struct Section;
  Parameters(std::string name, std::shared_ptr<Section> section);

  std::string name_;
  std::shared_ptr<Section> section_;  ///< shared by copies, with the memory of what was asked for
};

}  // namespace vins
