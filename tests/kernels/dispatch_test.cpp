#include <stdexcept>

#include "tests/kernels/all_paths.hpp"

namespace palpate::kernels {
namespace {

TEST(Dispatch, ThePlainPathIsAlwaysThereAndComesFirst) {
  ASSERT_FALSE(available().empty());
  EXPECT_EQ(available().front()->name, "x86-64");
}

TEST(Dispatch, UseChoosesByName) {
  for (const Table* table : available()) {
    use(table->name);
    EXPECT_EQ(active().name, table->name);
  }
}

TEST(Dispatch, AnUnknownPathIsRefusedByNameAndKeepsTheOldOne) {
  use("x86-64");
  try {
    use("x86-64-v9");
    FAIL() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("x86-64-v9"), std::string::npos);
  }
  EXPECT_EQ(active().name, "x86-64");
}

}  // namespace
}  // namespace palpate::kernels
