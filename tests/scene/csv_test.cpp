#include "common/describe/csv.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/scene/full_scene.hpp"

namespace palpate {
namespace {

TEST(Csv, ReadsNumbersBelowItsHeaderAndKeepsLineNumbers) {
  const SceneFolder folder;
  const CsvTable table =
      read_csv(folder.write("a.csv", "# made by hand\n\n a , b \n1,2\r\n\n# more\n -3e-2,+4\n"), {"a", "b"});
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0].line, 4);
  EXPECT_EQ(table.rows[0].values, (std::vector<double>{1, 2}));
  EXPECT_EQ(table.rows[1].line, 7);
  EXPECT_EQ(table.rows[1].values, (std::vector<double>{-0.03, 4}));
}

TEST(Csv, AByteOrderMarkIsNoPartOfTheFirstName) {
  const SceneFolder folder;
  EXPECT_EQ(read_csv(folder.write("a.csv",
                                  "\xef\xbb\xbf"
                                  "a,b\n1,2\n"),
                     {"a", "b"})
                .rows[0]
                .values,
            (std::vector<double>{1, 2}));
  EXPECT_EQ(
      read_csv(folder.write("b.csv", "\xef\xbb\xbf# by another program\r\na,b\r\n1,2\r\n"), {"a", "b"}).rows[0].line,
      3);
}

TEST(Csv, AnOptionalLastColumnIsThereForAllRowsOrForNone) {
  const SceneFolder folder;
  EXPECT_EQ(read_csv(folder.write("a.csv", "a,b\n1,2\n"), {"a", "b"}, "c").rows[0].values, (std::vector<double>{1, 2}));
  EXPECT_EQ(read_csv(folder.write("b.csv", "a,b,c\n1,2,3\n"), {"a", "b"}, "c").rows[0].values,
            (std::vector<double>{1, 2, 3}));
  EXPECT_THROW(read_csv(folder.write("c.csv", "a,b,c\n1,2,3\n1,2\n"), {"a", "b"}, "c"), std::runtime_error);
  EXPECT_THROW(read_csv(folder.write("d.csv", "a,b\n1,2,3\n"), {"a", "b"}, "c"), std::runtime_error);
  EXPECT_THROW(read_csv(folder.write("e.csv", "a,b,d\n1,2,3\n"), {"a", "b"}, "c"), std::runtime_error);
  EXPECT_THROW(read_csv(folder.write("f.csv", "a,b,c\n1,2,3\n"), {"a", "b"}), std::runtime_error);
}

TEST(Csv, RefusesWithTheLine) {
  const SceneFolder folder;
  const std::pair<const char*, const char*> cases[] = {
      {"", ":1: the header 'a,b' is missing"},
      {"# only this\n", ":1: the header 'a,b' is missing"},
      {"a,c\n1,2\n", ":1: the header must be 'a,b'"},
      {"1,2\n", ":1: the header must be 'a,b'"},
      {"a,b\n", ":1: there is no row of numbers"},
      {"a,b\n1,2\n3\n", ":3: 2 columns are needed, and there are 1"},
      {"a,b\n1,2,\n", ":2: 2 columns are needed, and there are 3"},
      {"a,b\n1,\n", ":2: '' is not a number"},
      {"a,b\n1,two\n", ":2: 'two' is not a number"},
      {"a,b\n1,2x\n", ":2: '2x' is not a number"},
      {"a,b\n1,nan\n", ":2: 'nan' is not a finite number"},
      {"a,b\n1,-inf\n", ":2: '-inf' is not a finite number"},
      {"a,b\n1,1e999\n", ":2: '1e999' is not a number"},
  };
  for (const auto& [text, sentence] : cases) {
    const auto file = folder.write("bad.csv", text);
    try {
      read_csv(file, {"a", "b"});
      ADD_FAILURE() << "accepted: " << text;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), file.string() + sentence);
    }
  }
  EXPECT_THROW(read_csv(folder / "absent.csv", {"a"}), std::runtime_error);
}

}  // namespace
}  // namespace palpate
