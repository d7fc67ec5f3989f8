// SPDX-License-Identifier: MIT
// The commands that need no Vulkan device, run where the loader finds no driver.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "cli_support.hpp"
#include "image/frame/frame_file.hpp"

namespace darkroom {
namespace {

using test::Outcome;

class CliNoDriver : public test::CliFixture {
  protected:
    void make_files() override {
        FrameFile frame;
        frame.color = Picture(48, 32);
        frame.depth = Plane<1>(48, 32);
        for (std::size_t i = 0; i < frame.color.pixels.size(); ++i)
            frame.color.pixels[i] = i % 4 == 3 ? 1.0f : static_cast<float>((i * 37) % 101) / 40.0f;
        ASSERT_TRUE(write_frame(path("frame.exr"), frame));
        for (Variable& variable : variables_) {
            if (const char* const value = std::getenv(variable.name)) variable.before = value;
            setenv(variable.name, "/nonexistent", 1);
        }
    }
    void TearDown() override {
        for (const Variable& variable : variables_)
            variable.before ? setenv(variable.name, variable.before->c_str(), 1) : unsetenv(variable.name);
        CliFixture::TearDown();
    }

  private:
    struct Variable {
        const char* name = nullptr;
        std::optional<std::string> before{};
    };
    std::vector<Variable> variables_{{"VK_DRIVER_FILES"}, {"VK_ICD_FILENAMES"}};
};

TEST_F(CliNoDriver, ThereIsNone) {
    const std::string none =
        "darkroom: no Vulkan device: the loader found no driver (VK_ERROR_INCOMPATIBLE_DRIVER); Mesa's software driver "
        "is in the package mesa-vulkan-drivers\n";
    expect_refused({"devices"}, 2, none);
    expect_refused({"develop", path("frame.exr"), "-o", path("out.png")}, 2, none);
}

TEST_F(CliNoDriver, PlansForAnAssumedDeviceAndSaysSo) {
    for (const std::vector<std::string>& flags : std::vector<std::vector<std::string>>{
             {}, {"--input", path("frame.exr")}, {"--bits", "half"}, {"--kernels", "raster"}, {"--no-fuse"}}) {
        std::vector<std::string> arguments{"plan"};
        arguments.insert(arguments.end(), flags.begin(), flags.end());
        const Outcome text = run(arguments);
        EXPECT_EQ(text.code, 0) << text.err;
        EXPECT_EQ(text.err, "");
        EXPECT_NE(text.out.find("\nremark: planned without a device: "), std::string::npos) << text.out;
        arguments.emplace_back("--json");
        const Outcome as_json = run(arguments);
        EXPECT_EQ(as_json.code, 0) << as_json.err;
        EXPECT_NE(as_json.out.find("\"planned without a device: "), std::string::npos) << as_json.out;
    }
    expect_refused({"plan", "--size", "99999x2"}, 1, "allows 1x1 to 16384x16384");
}

TEST_F(CliNoDriver, KernelsAreBaked) {
    const std::string look = write("look.toml", "format = 1\n[[stack]]\neffect = \"exposure\"\n");
    for (const char* const profile : {"gpu", "software"}) {
        const Outcome baked = run({"bake", look, "-o", path("kernels.dkb"), "--profile", profile});
        EXPECT_EQ(baked.code, 0) << baked.err;
    }
}

TEST_F(CliNoDriver, ADeviceThatIsAskedForIsNotAssumed) { expect_refused({"plan", "--device", "0"}, 2, "Vulkan"); }

}  // namespace
}  // namespace darkroom
