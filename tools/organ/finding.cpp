#include "tools/organ/finding.hpp"

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <set>
#include <stdexcept>

namespace palpate {
namespace {

std::string quoted(const std::string& text) {
  std::string all = "\"";
  for (const char c : text) all += c == '"' ? "\"\"" : std::string(1, c);
  return all + '"';
}

void write_report(const std::vector<Finding>& findings, const std::string& file) {
  std::ofstream out(file, std::ios::binary);
  out << "found,done,x_mm,y_mm,z_mm\n";
  for (const Finding& f : findings) {
    const std::string row = quoted(f.what) + "," + quoted(f.done) + ",";
    if (f.places.empty()) out << row << ",,\n";
    for (const Eigen::Vector3d& x : f.places)
      out << row << fmt::format("{:.6g},{:.6g},{:.6g}\n", 1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z());
  }
  if (!out.flush()) throw std::runtime_error(file + ": the file cannot be written");
}

}  // namespace

std::string place_in_mm(const Eigen::Vector3d& x) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) mm", 1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z());
}

std::string say(const Finding& f) {
  std::string text = f.what;
  if (!f.places.empty())
    text += fmt::format("{}{}", f.kind.empty() ? ", the first at " : " at ", place_in_mm(f.places[0]));
  return f.done.empty() ? text : text + ": " + f.done;
}

void tell_findings(const std::vector<Finding>& findings, const std::string& report, Output& out) {
  Output::Json& found = out.figures()["found"] = Output::Json::array();
  std::map<std::string, int> count;
  for (const Finding& f : findings) ++count[f.kind];
  std::set<std::string> told;
  for (const Finding& f : findings) {
    found.push_back({{"what", f.what}, {"done", f.done}, {"places", f.places.size()}});
    if (!f.places.empty()) found.back()["first_m"] = f.places[0];
    if (!f.kind.empty() && !told.insert(f.kind).second) continue;
    const int more = f.kind.empty() ? 0 : count[f.kind] - 1;
    out.say(
        fmt::format("  found: {}{}", say(f), more > 0 ? fmt::format(" (the first of {} {})", more + 1, f.kind) : ""));
  }
  if (!report.empty()) write_report(findings, report);
}

}  // namespace palpate
