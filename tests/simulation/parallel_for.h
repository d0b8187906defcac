#pragma once

#include <atomic>
#include <future>
#include <vector>

namespace vins::simulation {

/// Calls work(0) to work(count - 1), on `threads` threads, in any order. Rethrows what it throws.
template <typename Work>
void parallelFor(int count, int threads, const Work& work) {
  std::atomic<int> next{0};
  const auto run = [&] {
    for (int i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::future<void>> helpers;
  for (int i = 1; i < threads; ++i) helpers.push_back(std::async(std::launch::async, run));
  run();
  for (auto& helper : helpers) helper.get();
}

}  // namespace vins::simulation
