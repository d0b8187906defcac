// Runs a fuzz target without a fuzzer: the corpus, then random mutations of it, the same each time.
// Usage: fuzz_TARGET CORPUS_FOLDER [MUTATIONS]

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// The bounds that scripts/fuzz gives to libFuzzer.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
  return "max_allocation_size_mb=512:hard_rss_limit_mb=1024:allocator_may_return_null=0";
}

namespace {

using Input = std::vector<std::uint8_t>;

constexpr unsigned kSecondsPerInput = 20;  // on a busy machine, with sanitizers

std::vector<Input> readCorpus(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<Input> corpus;
  for (const auto& path : paths) {
    std::ifstream in(path, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return corpus;
}

/// Changes inputs in the ways in which files go wrong.
class Mutator {
 public:
  explicit Mutator(const std::vector<Input>& corpus) : corpus_(corpus) {}

  Input next() {
    Input input = corpus_[below(corpus_.size())];
    for (std::size_t changes = 1 + below(4); changes > 0; --changes) mutate(&input);
    return input;
  }

 private:
  std::size_t below(std::size_t end) { return end == 0 ? 0 : random_() % end; }

  void mutate(Input* input) {
    const auto at = static_cast<std::ptrdiff_t>(below(input->size()));
    const auto size =
        static_cast<std::ptrdiff_t>(below(std::min<std::size_t>(64, input->size()) + 1));
    const auto begin = input->begin() + at;
    const auto end = begin + std::min(size, input->end() - begin);
    switch (below(6)) {
      case 0:
        if (begin != input->end()) *begin = static_cast<std::uint8_t>(random_());
        break;
      case 1:
        if (begin != input->end()) *begin ^= static_cast<std::uint8_t>(1U << below(8));
        break;
      case 2:
        std::fill(begin, end, static_cast<std::uint8_t>(below(2) == 0 ? 0 : 0xff));
        break;
      case 3:
        input->erase(begin, end);
        break;
      case 4: {
        const Input copy(begin, end);
        input->insert(input->begin() + at, copy.begin(), copy.end());
        break;
      }
      default:
        input->resize(static_cast<std::size_t>(at));
    }
  }

  const std::vector<Input>& corpus_;
  std::mt19937_64 random_{1};
};

void run(const Input& input) {
  alarm(kSecondsPerInput);
  LLVMFuzzerTestOneInput(input.data(), input.size());
  alarm(0);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "usage: " << argv[0] << " CORPUS_FOLDER [MUTATIONS]\n";
    return 1;
  }
  const std::vector<Input> corpus = readCorpus(argv[1]);
  if (corpus.empty()) {
    std::cerr << argv[1] << ": is empty\n";
    return 1;
  }
  for (const Input& input : corpus) run(input);
  const int mutations = argc > 2 ? std::atoi(argv[2]) : 0;
  Mutator mutator(corpus);
  for (int i = 0; i < mutations; ++i) run(mutator.next());
  std::cout << corpus.size() << " inputs and " << mutations << " mutations\n";
  return 0;
}
