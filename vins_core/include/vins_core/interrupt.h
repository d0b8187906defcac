#pragma once

#include <csignal>
#include <ctime>

namespace vins {

/// Holds back SIGINT and SIGTERM, so that a program ends where it likes. To be made before any
/// thread is.
class Interrupt {
 public:
  Interrupt() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  }
  /// A signal that came and was not asked for takes effect; more of what was asked for does not.
  ~Interrupt() {
    const timespec at_once{0, 0};
    while (requested_ && sigtimedwait(&signals_, nullptr, &at_once) > 0) continue;
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// True once somebody has asked the program to end.
  bool isRequested() {
    const timespec at_once{0, 0};
    if (!requested_) requested_ = sigtimedwait(&signals_, nullptr, &at_once) > 0;
    return requested_;
  }

 private:
  sigset_t signals_{};
  sigset_t before_{};
  bool requested_ = false;
};

}  // namespace vins
