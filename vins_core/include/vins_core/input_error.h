#pragma once

#include <stdexcept>
#include <string>

namespace vins {

/// Bad input from a user: a file, a key, a stamp. The message says what was found, where, and what
/// is allowed, so that a person can act on it. The only exception that the libraries throw on
/// purpose; programs catch it in main() and end with exit code 1.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace vins
