#include <gtest/gtest.h>

#include <random>
#include <regex>

#include "common/scene/scene.hpp"
#include "tests/scene/full_scene.hpp"

namespace palpate {
namespace {

/// Changes a text in one of the ways in which scene files go wrong.
class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string mutate(std::string text) {
    for (int i = 1 + below(2); i > 0 && !text.empty(); --i) change(text);
    return text;
  }

 private:
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }

  void change(std::string& text) {
    static const std::string tokens[] = {"[",
                                         "]",
                                         "[[",
                                         "]]",
                                         "{",
                                         "}",
                                         "=",
                                         "\"",
                                         "\"\"\"",
                                         "'",
                                         "#",
                                         ",",
                                         ".",
                                         "\n",
                                         "nan",
                                         "-inf",
                                         "1e999",
                                         "-1",
                                         "0x7fffffffffffffff",
                                         "9223372036854775808",
                                         "1979-05-27",
                                         "true",
                                         "\\u0000",
                                         "\\",
                                         "\xff",
                                         "\xf0\x9f\x98\x80",
                                         std::string(1, '\0'),
                                         "[body.fixed]",
                                         "[[body]]",
                                         "[tool]",
                                         "name.x = 1\n",
                                         "[render]\n",
                                         "[]",
                                         "{}",
                                         "young = 1\n",
                                         "\r\n",
                                         "\xef\xbb\xbf"};
    const std::size_t at = below(text.size());
    const std::size_t length = std::min(text.size() - at, 1 + below(40));
    switch (below(6)) {
      case 0:
        text[at] = static_cast<char>(below(256));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, tokens[below(std::size(tokens))]);
        break;
      case 3:
        text.insert(below(text.size()), text.substr(at, length));
        break;
      case 4:
        text.replace(at, length, tokens[below(std::size(tokens))]);
        break;
      default:
        text.resize(at);
        break;
    }
  }

  std::mt19937 random_;
};

TEST(SceneFuzz, AMutatedSceneIsReadOrRefusedInWordsWithAPlace) {
  const SceneFolder folder;
  const auto file = folder / "scene.toml";
  const std::regex sentence(R"(\d+:\d+: [\s\S]+)");
  Mutator mutator(20250607);
  int read = 0, refused = 0;
  for (int i = 0; i < 10000; ++i) {
    const std::string text = mutator.mutate(i % 3 ? kFullScene : kMinimalScene);
    try {
      const Scene scene = parse_scene(text, file);
      ASSERT_EQ(to_toml(parse_scene(to_toml(scene), file)), to_toml(scene)) << text;
      ++read;
    } catch (const std::runtime_error& error) {
      const std::string said = error.what(), start = file.string() + ":";
      ASSERT_TRUE(said.starts_with(start)) << said << "\n" << text;
      ASSERT_TRUE(std::regex_match(said.substr(start.size()), sentence)) << said;
      ++refused;
    }
  }
  EXPECT_GT(read, 100);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace palpate
