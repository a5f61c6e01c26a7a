#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>

#include "tests/network/two_hosts.hpp"

/// For the body of a test: two hosts in `hosts`, or the test is skipped with the reason.
#define PALPATE_TWO_HOSTS_OR_SKIP(hosts, ...)                          \
  try {                                                                \
    hosts = std::make_unique<palpate::testing::TwoHosts>(__VA_ARGS__); \
  } catch (const std::runtime_error& reason) {                         \
    GTEST_SKIP() << reason.what();                                     \
  }
