#include "splitfusion/lib/sequence/sensors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

TEST(Sensors, HaveNoiseThatFitsTheirWeights) {
  for (const std::string& name : SensorNames()) {
    const DepthOptions sensor = SensorOptions(name);
    sensor.Check();
    const DepthNoise& noise = sensor.noise;
    EXPECT_LE(noise.Sigma(noise.reference), 0.0032) << name;
    EXPECT_EQ(noise.Confidence(static_cast<float>(sensor.min_depth)), 1);
    EXPECT_LE(noise.Sigma(sensor.max_depth), 0.1) << name;
  }
}

TEST(Sensors, DifferAsTheirPrinciplesDo) {
  const auto sigma = [](const std::string& name, double z) {
    return SensorOptions(name).noise.Sigma(z);
  };
  // Stereo has errors that grow with the square, time of flight hardly grows.
  EXPECT_NEAR(sigma("realsense", 2.0), 0.0162, 1e-6);
  EXPECT_LT(sigma("kinect_azure", 3.8), sigma("kinect_v1", 3.8) / 2);
  EXPECT_EQ(sigma("ideal", 0.5), sigma("ideal", 5.0));
}

TEST(Sensors, AreNamedWhereOneIsUnknown) {
  try {
    SensorOptions("lidar");
    FAIL();
  } catch (const OptionError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("kinect_azure"));
    EXPECT_EQ(error.field(), "sensor");
  }
}

}  // namespace
}  // namespace splitfusion
