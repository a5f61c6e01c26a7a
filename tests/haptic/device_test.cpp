#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "common/bus/log_writer.hpp"
#include "common/bus/memory_bus.hpp"
#include "haptic_node/bus_devices.hpp"
#include "idl/topics.hpp"
#include "tests/haptic/device_scene.hpp"

namespace palpate {
namespace {

using testing::device_with;
using testing::scene_with;

class DeviceTest : public ::testing::Test {
 protected:
  DeviceTest() : file_(std::filesystem::temp_directory_path() / ("palpate-device-" + std::to_string(getpid()))) {}
  ~DeviceTest() override { std::filesystem::remove(file_); }
  std::filesystem::path file_;
};

TEST_F(DeviceTest, ALogPlaysTheMotionOfItsToolStepByStepAndRepeatsWhatWasLost) {
  {
    LogWriter log(file_);
    log.write(kHeaderChannel, 1, LogHeader{.schema = schema_text()});
    for (std::uint64_t step = 40; step < 60; ++step) {
      if (step == 45) continue;  // lost
      log.write(topics::tool_state.name, 2,
                ToolState{.tool = 0, .run = 7, .seq = step, .step = step, .depth = 1e-3 * static_cast<double>(step)});
      log.write(topics::tool_state.name, 2, ToolState{.tool = 1, .run = 7, .seq = step, .step = step, .depth = 9});
    }
  }
  const auto device = device_with(LogDeviceSpec{file_});
  EXPECT_DOUBLE_EQ(device->read(0).dofs.depth, 0.040);
  EXPECT_DOUBLE_EQ(device->read(0.004).dofs.depth, 0.044);
  EXPECT_DOUBLE_EQ(device->read(0.005).dofs.depth, 0.044);
  EXPECT_DOUBLE_EQ(device->read(0.006).dofs.depth, 0.046);
  EXPECT_FALSE(device->finished(0.019));
  EXPECT_TRUE(device->finished(0.020));
  EXPECT_DOUBLE_EQ(device->read(5).dofs.depth, 0.059);
}

TEST_F(DeviceTest, ALogWithoutTheToolIsRefusedByName) {
  {
    LogWriter log(file_);
    log.write(kHeaderChannel, 1, LogHeader{.schema = schema_text()});
    log.write(topics::tool_state.name, 2, ToolState{.tool = 3, .run = 7, .seq = 1, .step = 0});
  }
  try {
    device_with(LogDeviceSpec{file_});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("no motion of tool 'probe'"), std::string::npos) << error.what();
  }
}

TEST_F(DeviceTest, ADriverElsewhereMovesItsOwnToolAlone) {
  Scene scene = scene_with(BusDeviceSpec{});
  scene.tools.push_back(scene.tools[0]);
  auto devices = make_devices(scene.tools, 1000);
  const auto network = make_memory_network();
  const auto here = make_memory_bus(network), elsewhere = make_memory_bus(network);
  BusDevices drivers(*here, devices);
  ASSERT_TRUE(drivers.needed());
  EXPECT_FALSE(devices[1]->ready());
  elsewhere->writer(topics::device_state)->write({.tool = 1, .seq = 5, .yaw = 0.25, .depth = 0.1});
  drivers.take();
  EXPECT_FALSE(devices[0]->ready());
  ASSERT_TRUE(devices[1]->ready());
  EXPECT_DOUBLE_EQ(devices[1]->read(0).dofs.yaw, 0.25);
  EXPECT_EQ(devices[1]->read(0).seq, 5u);
}

TEST_F(DeviceTest, ADriverOfAToolThatNoneElsewhereMovesIsNotHeardAndSoItIsSaidOnce) {
  const Scene scene = scene_with(BusDeviceSpec{});
  auto devices = make_devices(scene.tools, 1000);
  const auto network = make_memory_network();
  const auto here = make_memory_bus(network), elsewhere = make_memory_bus(network);
  BusDevices drivers(*here, devices);
  const auto writer = elsewhere->writer(topics::device_state);
  const auto said = [&](std::uint64_t seq) {
    writer->write({.tool = 3, .seq = seq, .depth = 0.1});
    ::testing::internal::CaptureStdout();
    drivers.take();
    return ::testing::internal::GetCapturedStdout();
  };
  EXPECT_NE(said(1).find("moves tool 3, which no driver elsewhere moves in this scene"), std::string::npos);
  EXPECT_EQ(said(2), "");
  EXPECT_FALSE(devices[0]->ready());
}

TEST_F(DeviceTest, AToolDoesThePartOfItsDriversMotionThatTheSceneSays) {
  const auto device = device_with(BusDeviceSpec{.motion_scale = 0.5});
  device->put({.dofs = {.yaw = 0.2, .pitch = -0.1, .depth = 0.12, .roll = 0.3, .grip = 0.4}, .seq = 1});
  const ToolDofs dofs = device->read(0).dofs;
  EXPECT_DOUBLE_EQ(dofs.yaw, 0.1);
  EXPECT_DOUBLE_EQ(dofs.pitch, -0.05);
  EXPECT_DOUBLE_EQ(dofs.depth, 0.06);
  EXPECT_DOUBLE_EQ(dofs.roll, 0.3);
  EXPECT_DOUBLE_EQ(dofs.grip, 0.4);
}

}  // namespace
}  // namespace palpate
