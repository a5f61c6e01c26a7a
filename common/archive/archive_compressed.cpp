#include "common/archive/archive_compressed.hpp"

#include <algorithm>
#include <stdexcept>

#include "common/archive/compressed_compliance.hpp"
#include "common/archive/rows.hpp"

namespace palpate {
namespace {

using Blocks = std::vector<ComplianceBlock>;

std::vector<std::int32_t> flatten_blocks(const Blocks& blocks) {
  return flatten(blocks, 5, [](const ComplianceBlock& b, std::size_t c) {
    return std::int32_t{std::array{b.row, b.row_end, b.column, b.column_end, b.rank}[c]};
  });
}

/// Whether it is among touchable nodes; no block is partly.
bool is_touchable(const ComplianceBlock& block, int touchable) {
  return block.row_end <= touchable;
}

/// Blocks with what they have: first those among touchable nodes, then the others.
std::array<CompressedTensors, 2> split(const CompressedTensors& all) {
  std::array<CompressedTensors, 2> parts;
  auto from = all.values.begin();
  for (const ComplianceBlock& b : all.blocks) {
    CompressedTensors& part = parts[is_touchable(b, all.touchable) ? 0 : 1];
    part.blocks.push_back(b);
    part.values.insert(part.values.end(), from, from + static_cast<std::ptrdiff_t>(b.numbers()));
    from += static_cast<std::ptrdiff_t>(b.numbers());
  }
  return parts;
}

void append(const Hdf5Reader& file, const std::string& which, CompressedTensors& to) {
  for (const auto& [row, row_end, column, column_end, rank] :
       rows_of<std::array<int, 5>>(5, file.integers("compressed/" + which + "_blocks")))
    to.blocks.push_back({row, row_end, column, column_end, rank});
  std::vector<float> values = file.floats("compressed/" + which);
  if (to.values.empty())
    to.values = std::move(values);
  else
    to.values.insert(to.values.end(), values.begin(), values.end());
}

/// The surface nodes with free axes, by the dofs.
std::vector<int> nodes_of(const std::vector<Dof>& dofs) {
  std::vector<int> nodes;
  for (const Dof& dof : dofs)
    if (nodes.empty() || nodes.back() != dof.node) nodes.push_back(dof.node);
  return nodes;
}

/// The touchable ones before the others.
bool orders_all(const CompressedTensors& t, const Archive& archive) {
  const std::vector<int> touchable = nodes_of(archive.touchable_dofs), others = nodes_of(archive.other_dofs);
  std::vector<int> front = t.order;
  if (t.touchable != static_cast<int>(touchable.size()) || front.size() != touchable.size() + others.size())
    return false;
  std::vector<int> back(front.begin() + t.touchable, front.end());
  front.resize(t.touchable);
  std::ranges::sort(front);
  std::ranges::sort(back);
  return front == touchable && back == others;
}

}  // namespace

void write_compressed(Hdf5Writer& file, const Archive& archive) {
  if (!archive.compressed) return;
  const CompressedTensors& tensors = archive.compressed->tensors();
  const auto [touchable, others] = split(tensors);
  file.attribute("compressed_scale", archive.compressed->scale());
  file.attribute("compressed_touchable", std::int64_t{tensors.touchable});
  file.dataset({"compressed/order", "1", "surface node at each place; clusters of nodes are ranges of places"},
               std::vector<std::int32_t>(tensors.order.begin(), tensors.order.end()));
  const auto write = [&](const std::string& which, const CompressedTensors& part, const char* rows) {
    file.dataset({"compressed/" + which + "_blocks", "1",
                  std::string(rows) + ": first place and end of the rows, of the columns; rank, -1 where dense"},
                 flatten_blocks(part.blocks), 5);
    file.dataset({"compressed/" + which, "m/N",
                  "block after block; dense: 3 x 3 of each pair of nodes by columns, the nodes of a column one after "
                  "another; else U, then V, of U V^T: three rows a node. To be multiplied by compressed_scale"},
                 part.values);
  };
  write("touchable", touchable, "blocks among touchable nodes, on and below the diagonal");
  write("other", others, "blocks of other nodes against touchable ones");
}

void read_compressed(const Hdf5Reader& file, ArchivePart part, Archive& archive) {
  if (part == ArchivePart::header || !file.has_attribute("compressed_scale")) return;
  CompressedTensors tensors;
  const auto order = file.integers("compressed/order");
  tensors.order.assign(order.begin(), order.end());
  tensors.touchable = file.count("compressed_touchable");
  append(file, "touchable", tensors);
  if (part == ArchivePart::surface) append(file, "other", tensors);
  const double scale = file.number("compressed_scale");
  if (!orders_all(tensors, archive) || !(scale > 0)) file.fail("damaged: its datasets do not fit together");
  try {
    archive.compressed = std::make_shared<CompressedCompliance>(std::move(tensors), archive.surface.size(), scale);
  } catch (const std::invalid_argument& error) {
    file.fail(std::string("damaged: ") + error.what());
  }
  if (part == ArchivePart::surface && !archive.other_dofs.empty() && !archive.compressed->has_others())
    file.fail("damaged: its datasets do not fit together");
}

std::size_t compressed_payload_bytes(const Archive& archive) {
  if (!archive.compressed) return 0;
  const CompressedTensors& t = archive.compressed->tensors();
  return sizeof(float) * t.values.size() + sizeof(std::int32_t) * (t.order.size() + 5 * t.blocks.size());
}

}  // namespace palpate
