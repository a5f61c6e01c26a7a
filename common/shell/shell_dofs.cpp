#include "common/shell/shell_dofs.hpp"

namespace palpate {

ShellDofs::ShellDofs(const std::vector<char>& used) {
  for (char u : used) index_.insert(index_.end(), 6, u ? 0 : kUnused);
  number();
}

void ShellDofs::fix(int node, int dof) {
  if (index_[6 * node + dof] != kUnused) index_[6 * node + dof] = kFixed;
}

void ShellDofs::number() {
  dof_.clear();
  for (int half : {0, 3}) {
    for (int node = 0; node < nodes(); ++node)
      for (int axis = half; axis < half + 3; ++axis) {
        int& index = index_[6 * node + axis];
        if (index < 0) continue;
        index = static_cast<int>(dof_.size());
        dof_.push_back(6 * node + axis);
      }
    if (half == 0) translations_ = static_cast<int>(dof_.size());
  }
}

}  // namespace palpate
