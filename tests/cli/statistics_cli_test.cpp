// SPDX-License-Identifier: MIT
// `plan --statistics` by RADV's null devices, which compile for GPUs that are not there, and their refusal elsewhere.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "cli_support.hpp"
#include "image/frame/frame_file.hpp"

namespace darkroom {
namespace {

using test::Outcome;

class CliStatistics : public test::CliFixture {
  protected:
    void SetUp() override {
        CliFixture::SetUp();
        force("navi21");
        if (run({"devices"}).out.find(null_device) == std::string::npos)
            GTEST_SKIP() << "RADV (package mesa-vulkan-drivers) is not there";
    }
    void TearDown() override {
        unsetenv(variable);
        CliFixture::TearDown();
    }
    static void force(const char* family) { setenv(variable, family, 1); }
    [[nodiscard]] nlohmann::json statistics(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), {"plan", "--statistics", "--json"});
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        return nlohmann::json::parse(outcome.out, nullptr, false);
    }
    static constexpr const char* variable = "RADV_FORCE_FAMILY";
    static constexpr const char* null_device = "Null hardware (RADV NAVI21)";
};

TEST_F(CliStatistics, OneKernelForEachPassOfThePlan) {
    const auto plan = nlohmann::json::parse(run({"plan", "--json"}).out);
    const auto found = statistics({});
    EXPECT_EQ(found["device"], null_device);
    EXPECT_EQ(found["chip"]["name"], "RX 6800 XT");
    ASSERT_EQ(found["kernels"].size(), plan["passes"].size());
    double milliseconds = 0;
    for (std::size_t i = 0; i < plan["passes"].size(); ++i) {
        const auto& kernel = found["kernels"][i];
        EXPECT_EQ(kernel["name"], plan["passes"][i]["name"]);
        EXPECT_GT(kernel["driver"]["VGPRs"], 0);
        EXPECT_GE(kernel["waves"], 1);
        EXPECT_LE(kernel["waves"], 16) << "as many as a SIMD of RDNA 2 holds";
        EXPECT_EQ(kernel["cycles"],
                  std::max({double{kernel["alu"]}, double{kernel["texture"]}, double{kernel["lds"]}}));
        milliseconds += double{kernel["milliseconds"]};
    }
    EXPECT_GT(milliseconds, 0);
    EXPECT_NEAR(milliseconds, found["milliseconds"], 1e-9);
}

TEST_F(CliStatistics, KernelsAreLeanWithThePresentChoices) {
    const auto instructions = [&](const std::string& curve) {
        const auto found = statistics({"--fxaa-enabled", "off", "--set", "tonemap.curve=" + curve});
        return double{found["kernels"].back()["driver"]["Instructions"]};
    };
    EXPECT_NE(instructions("aces_hill"), instructions("reinhard_extended"));
    const auto of_four = statistics({write("blur.toml", "[[stack]]\neffect = \"gaussian_blur\"\nradius = 4.0\n")});
    const auto of_six = statistics({write("blur.toml", "[[stack]]\neffect = \"gaussian_blur\"\nradius = 6.0\n")});
    EXPECT_GT(double{of_six["kernels"][0]["texture"]}, 1.5 * double{of_four["kernels"][0]["texture"]});
}

TEST_F(CliStatistics, AnotherGpuAnotherCost) {
    const auto on_rdna = statistics({});
    force("vega10");
    const auto on_gcn = statistics({});
    EXPECT_EQ(on_gcn["chip"]["name"], "RX Vega 64");
    EXPECT_GT(double{on_gcn["cycles"]}, 1.5 * double{on_rdna["cycles"]}) << "its SIMDs have half the lanes";
    force("polaris10");
    const auto unlisted = statistics({});
    EXPECT_FALSE(unlisted.contains("chip")) << "no such card is in the table";
    EXPECT_GT(double{unlisted["cycles"]}, 0);
}

TEST_F(CliStatistics, SmallerFramesAreFaster) {
    EXPECT_LT(double{statistics({"--size", "960x540"})["milliseconds"]}, double{statistics({})["milliseconds"]} / 3);
}

TEST_F(CliStatistics, LoopsThatNobodyKnowsAreGuessedOrTold) {
    const std::string look = write("rays.toml", "[[stack]]\neffect = \"god_rays\"\n");
    const auto march = [&](const nlohmann::json& found) {
        for (const auto& kernel : found["kernels"])
            if (!kernel["loops"].empty()) return kernel;
        return nlohmann::json();
    };
    const auto guessed = march(statistics({look}));
    ASSERT_TRUE(guessed.is_object()) << "the number of samples comes from a block of values";
    EXPECT_FALSE(guessed["loops"][0]["is_known"]);
    const std::string name = guessed["name"];
    const auto told = march(statistics({look, "--loops", name + "=16"}));
    EXPECT_EQ(told["loops"][0]["trips"], 16);
    EXPECT_NEAR(double{told["texture"]} / double{guessed["texture"]}, 2, 0.1) << "the guess is 8";
    expect_refused({"plan", look, "--statistics", "--loops", name + "=1,2"}, 1, "has 1 loops");
    expect_refused({"plan", look, "--statistics", "--loops", "nothing=1"}, 1,
                   "--loops nothing: the plan has no kernel");
    for (const char* const wrong : {"nothing", "=1", "a=", "a=1,", "a=-1", "a=x", "a=nan", "a=inf"})
        expect_refused({"plan", look, "--statistics", "--loops", wrong}, 1, "expected KERNEL=N");
}

TEST_F(CliStatistics, TextSaysForWhat) {
    const Outcome outcome = run({"plan", "--ssao", "--statistics", "--chip", "rx 6800 xt"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    for (const char* const part : {"Null hardware (RADV NAVI21)", "ms: on RX 6800 XT, 144 SIMDs, 2.25 GHz, 512 GB/s",
                                   "VGPR", "waves", "bound", "a frame: ", "left out: "})
        EXPECT_NE(outcome.out.find(part), std::string::npos) << part << " is not in " << outcome.out;
}

TEST_F(CliStatistics, ChipsThatDoNotFitAreRefused) {
    expect_refused({"plan", "--statistics", "--chip", "Voodoo"}, 1, "--chip Voodoo: allowed is RX Vega 64");
    expect_refused({"plan", "--statistics", "--chip", "RX 7900 XTX"}, 1, "does not compile for it");
    expect_refused({"plan", "--chip", "RX 6800 XT"}, 1, "--chip requires --statistics");
}

TEST_F(CliStatistics, DriversWithoutStatisticsSaySo) {
    expect_refused({"plan", "--statistics", "--device", "llvmpipe"}, 2, "VK_KHR_pipeline_executable_properties");
}

TEST_F(CliStatistics, NoPictureIsGivenToANullDevice) {
    FrameFile frame;
    frame.color = Picture(16, 16);
    ASSERT_TRUE(write_frame(path("frame.exr"), frame));
    EXPECT_NE(run({"devices"}).out.find("not usable: it is a null device"), std::string::npos);
    const std::string refusal = "it is a null device, which compiles for hardware that is not there and runs nothing";
    for (const std::vector<std::string>& command :
         std::vector<std::vector<std::string>>{{"develop", path("frame.exr"), "-o", path("out.png")},
                                               {"probe", path("frame.exr"), "--at", "1,1"},
                                               {"plan"}}) {
        std::vector<std::string> arguments = command;
        arguments.insert(arguments.end(), {"--device", null_device});
        expect_refused(arguments, 2, refusal);
    }
}

}  // namespace
}  // namespace darkroom
