#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "common/kernels/kernels.hpp"

namespace palpate::kernels {

/// A test that runs on every code path of this processor.
class EveryPath : public ::testing::TestWithParam<const Table*> {
 protected:
  const Table& table() const { return *GetParam(); }
};

inline std::string path_name(const ::testing::TestParamInfo<const Table*>& info) {
  std::string name(info.param->name);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

}  // namespace palpate::kernels
