#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/rounds.hpp"
#include "tests/tensors/files_for_tests.hpp"

namespace palpate::testing {

struct Sample {
  std::string name, bytes;
};

class TextSpoiler {
 public:
  explicit TextSpoiler(unsigned seed) : random_(seed) {}

  std::string spoil(std::string bytes) {
    if (bytes.empty()) return bytes;
    const std::size_t at = random_() % bytes.size(), length = std::min(bytes.size() - at, 1 + random_() % 60);
    switch (random_() % 6) {
      case 0:
        return bytes.replace(at, length, std::string(random_() % 2, static_cast<char>(random_() % 256)));
      case 1:
        return bytes.insert(random_() % bytes.size(), bytes.substr(at, length));
      case 2:
        return bytes.substr(0, at);
      case 3:
        return with_number_of_bytes(std::move(bytes), at);
      default:
        return with_number(std::move(bytes), at);
    }
  }

 private:
  /// In place of the next one that is written out.
  std::string with_number(std::string text, std::size_t from) {
    const std::size_t begin = text.find_first_of("0123456789", from);
    if (begin == std::string::npos) return text;
    const std::size_t end = std::min(text.find_first_not_of("0123456789.eE+-", begin), text.size());
    static const std::array<const char*, 16> numbers{"nan",
                                                     "inf",
                                                     "-inf",
                                                     "1e308",
                                                     "-1e308",
                                                     "1e999",
                                                     "5e-324",
                                                     "0",
                                                     "-1",
                                                     "2147483647",
                                                     "2147483648",
                                                     "-2147483649",
                                                     "18446744073709551615",
                                                     "9999999999999999999999",
                                                     "0x10",
                                                     "1.5.5"};
    return text.replace(begin, end - begin, any_of(numbers, random_));
  }
  std::string with_number_of_bytes(std::string bytes, std::size_t at) {
    if (bytes.size() < 8) return bytes;
    at = std::min(at, bytes.size() - 8);
    const double number = any_of(kExtremeNumbers, random_);
    const std::int32_t whole = any_of(kExtremeIntegers, random_);
    random_() % 2 ? std::memcpy(&bytes[at], &number, 8) : std::memcpy(&bytes[at], &whole, 4);
    return bytes;
  }

  std::mt19937 random_;
};

/// Reads it, or says why not with the file's name in front.
template <class Read>
bool reads(const std::filesystem::path& file, Read&& read) {
  try {
    read();
    return true;
  } catch (const std::runtime_error& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with(file.string() + ":")) << error.what();
    return false;
  }
}

/// Spoils each sample in turn, some of them more than once.
template <class Read>
void spoil_all(const std::vector<Sample>& samples, int rounds, unsigned seed, Read&& read) {
  const TemporaryFolder folder;
  TextSpoiler spoiler(seed);
  int whole = 0, done = 0;
  fuzz(rounds, 1, [&](int round) {
    const Sample& sample = samples[round % samples.size()];
    std::string bytes = spoiler.spoil(sample.bytes);
    for (int more = round % 3; more > 0; --more) bytes = spoiler.spoil(bytes);
    const auto file = folder / sample.name;  // lies there where the test does not live to tell
    write_bytes(file, {bytes.begin(), bytes.end()}, bytes.size());
    SCOPED_TRACE(fmt::format("round {}, {}", round, sample.name));
    whole += read(file);
    ++done;
  });
  fmt::print("{} files, {} of them read\n", done, whole);
  EXPECT_LT(whole, done);
}

}  // namespace palpate::testing
