#include "tools/solution_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

namespace palpate {
namespace {

SolutionTable example() {
  SolutionTable table;
  table.node = {4, 7, 9, 11};
  table.position = {{0, 0, 0}, {1.0 / 3, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  table.displacement = {{0, 0, 0}, {0.1, 0.2, 0.3}, {0, 0, 0}, {1e-300, 0, 0}};
  table.force = {{1, 2, 3}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  table.tetrahedra = {{0, 1, 2, 3}};
  return table;
}

std::filesystem::path temporary(const std::string& name) {
  return std::filesystem::temp_directory_path() / (std::to_string(getpid()) + name);
}

std::string slurp(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  std::filesystem::remove(file);
  return text.str();
}

TEST(SolutionFile, CsvKeepsEveryDigit) {
  const auto file = temporary("a.csv");
  write_csv(example(), file);
  std::istringstream text(slurp(file));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "node,x,y,z,ux,uy,uz,fx,fy,fz");
  std::getline(text, line);
  EXPECT_EQ(line, "4,0,0,0,0,0,0,1,2,3");
  std::getline(text, line);
  EXPECT_EQ(std::stod(line.substr(line.find(',') + 1)), 1.0 / 3);
}

TEST(SolutionFile, CsvListsOnlyTheChosenPoints) {
  auto table = example();
  table.listed = {0, 1, 0, 1};
  const auto file = temporary("b.csv");
  write_csv(table, file);
  const auto text = slurp(file);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
}

TEST(SolutionFile, RefusesAFolderThatDoesNotExist) {
  EXPECT_THROW(write_csv(example(), "/nonexistent/a.csv"), std::runtime_error);
  EXPECT_THROW(write_vtu(example(), "/nonexistent/a.vtu"), std::runtime_error);
}

/// An XML parser counts what ParaView would read.
TEST(SolutionFile, VtuIsWellFormedAndComplete) {
  const auto file = temporary("c.vtu");
  write_vtu(example(), file);
  const std::string check =
      "/usr/bin/python3 -c \"import sys, xml.etree.ElementTree as E\n"
      "p = E.parse(sys.argv[1]).getroot().find('UnstructuredGrid/Piece')\n"
      "a = {d.get('Name'): d.text.split() for d in p.iter('DataArray')}\n"
      "assert p.get('NumberOfPoints') == '4' and p.get('NumberOfCells') == '1'\n"
      "assert len(a['position']) == 12 and float(a['position'][3]) == 1/3\n"
      "assert a['connectivity'] == ['0','1','2','3'] and a['offsets'] == ['4'] and a['types'] == ['10']\n"
      "assert len(a['displacement']) == 12 and len(a['force']) == 12 and a['node'] == "
      "['4','7','9','11']\n\" ";
  EXPECT_EQ(std::system((check + file.string()).c_str()), 0);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace palpate
