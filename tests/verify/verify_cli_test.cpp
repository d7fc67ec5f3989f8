// SPDX-License-Identifier: MIT
// `darkroom verify`: lines for people, a document for programs, and a folder.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <darkroom/effects.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "image/frame/frame_file.hpp"
#include "tests/cli/cli_support.hpp"
#include "verifier/verify_report.hpp"

namespace darkroom {
namespace {

using nlohmann::json;
using test::Outcome;

class CliVerify : public test::CliFixture {
  protected:
    void SetUp() override {
        if (find_effect("exposure") == nullptr) GTEST_SKIP() << "the effect exposure is not in this build";
        CliFixture::SetUp();
    }
};

TEST_F(CliVerify, TellsOfDeviceAndKernels) {
    const Outcome done =
        run({"verify", "--effect", "exposure", "--json", "--report", path("report.json"), "-o", path("verified")});
    ASSERT_EQ(done.code, 0) << done.err;
    const json report = json::parse(done.out);
    EXPECT_EQ(report, json::parse(test::content(path("report.json"))));
    EXPECT_EQ(report, json::parse(test::content(path("verified/verify.json"))));
    EXPECT_FALSE(report["device"]["driver"].get<std::string>().empty());
    EXPECT_TRUE(report["device"]["traits"].contains("subTexelPrecisionBits"));
    EXPECT_GE(report["kernels"], 4);
    EXPECT_GE(report["pictures"], 16) << "as it is and with random values, at several sizes";
    EXPECT_TRUE(report["findings"].empty());
}

class SoakVerify : public CliVerify {};

TEST_F(SoakVerify, FindsNothingInAnyEffect) {
    const Outcome done = run({"verify"});
    EXPECT_EQ(done.code, 0) << done.out << done.err;
}

TEST_F(CliVerify, RefusesWhatThereIsNot) {
    const Outcome unknown = run({"verify", "--effect", "exposre"});
    EXPECT_EQ(unknown.code, 1);
    EXPECT_NE(unknown.err.find("--effect exposre: there is no such effect"), std::string::npos) << unknown.err;
    EXPECT_NE(unknown.err.find("exposure"), std::string::npos) << unknown.err;
    const Outcome seconds = run({"verify", "--seconds", "0"});
    EXPECT_EQ(seconds.code, 1);
    EXPECT_NE(seconds.err.find("--seconds = 0: allowed is [1, 86400] s"), std::string::npos) << seconds.err;
}

TEST_F(CliVerify, RefusesWhereItCannotWriteBeforeItWorks) {
    std::filesystem::create_directory(path("folder"));
    std::ofstream(path("file")) << "kept";
    struct Case {
        std::vector<std::string> flags;
        std::string says;
    };
    const std::string file = path("file"), folder = path("folder"), report = path("new/../new/verify.json");
    const Case cases[]{{{"-o", file}, file},
                       {{"-o", file + "/below"}, file + "/below: cannot be made: "},
                       {{"--report", folder}, folder + ": "},
                       {{"--report", path("none/report.json")}, path("none") + ": no such folder"},
                       {{"-o", path("new"), "--report", report},
                        "--report " + report + ": would be written by -o " + path("new") + ", too"}};
    for (const auto& [flags, says] : cases) {
        std::vector<std::string> all{"verify", "--effect", "exposure"};
        all.insert(all.end(), flags.begin(), flags.end());
        const Outcome done = run(all);
        EXPECT_EQ(done.code, 1) << says;
        EXPECT_TRUE(done.out.empty()) << done.out;
        EXPECT_NE(done.err.find(says), std::string::npos) << done.err;
        EXPECT_EQ(std::ranges::count(done.err, '\n'), 1) << "one line, and no effect was begun: " << done.err;
    }
    EXPECT_EQ(test::content(file), "kept");
}

TEST_F(CliVerify, AnotherSeedHasOtherValuesAtRandom) {
    const Outcome done = run({"verify", "--effect", "exposure", "--json", "--seed", "4294967295"});
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(json::parse(done.out)["seed"], 4294967295U);
    const Outcome wrong = run({"verify", "--seed", "-1"});
    EXPECT_EQ(wrong.code, 1);
    EXPECT_NE(wrong.err.find("--seed = -1: allowed is"), std::string::npos) << wrong.err;
}

void expect_same(const std::string& file, const ReferenceImage& expected) {
    const Result<FrameFile> found = read_frame(file);
    ASSERT_TRUE(found) << found.error().text;
    ASSERT_EQ(found->color.width, expected.width);
    ASSERT_EQ(found->color.height, expected.height);
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
        const float* const p = found->color.pixels.data() + 4 * i;
        EXPECT_NEAR(p[1], expected.pixels[i].g, 1e-6 * std::abs(expected.pixels[i].g)) << file << ", " << i;
        EXPECT_EQ(p[3], static_cast<float>(expected.pixels[i].a)) << file << ", " << i;
    }
}

// What is sent to the maker of a driver is enough to see it there.
TEST_F(CliVerify, AFindingIsAFolderThatDevelopRepeats) {
    const EffectInfo& info = *find_effect("exposure");
    verify::Subject subject{.name = "exposure", .steps = {{&info, {std::bit_cast<std::uint32_t>(2.0F)}}}};
    const std::vector<verify::SceneFrame> frames{verify::SceneFrame({8, 6}, verify::frame_count - 1)};
    const Result<verify::Expectation> expectation = verify::expect(subject, frames, {});
    ASSERT_TRUE(expectation) << expectation.error().text;
    ReferenceImage made = expectation->picture;
    made.at(5, 4).g += 1;
    verify::Report report;
    report.findings.push_back({.subject = subject,
                               .form = {.stage = KernelStage::Compute, .is_lean = true, .extent = {8, 6}},
                               .kernels = {"exposure"},
                               .worst = verify::difference(made, *expectation),
                               .made = made,
                               .expected = expectation->picture,
                               .smallest = subject,
                               .smallest_extent = {8, 6}});
    const Result<> done = app::write_findings(path("found"), report);
    ASSERT_TRUE(done) << done.error().text;

    const std::string folder = path("found/01_exposure_compute_lean/");
    expect_same(folder + "made.exr", made);
    expect_same(folder + "expected.exr", expectation->picture);
    EXPECT_TRUE(std::filesystem::exists(folder + "difference.png"));
    const Outcome again = run({"develop", folder + "frame.0002.exr", "--look", folder + "look.toml", "--reference",
                               "-o", path("again.exr"), "--alpha", "--bits", "float"});
    ASSERT_EQ(again.code, 0) << again.err;
    expect_same(path("again.exr"), expectation->picture);

    const json found = json::parse(test::content(path("found/verify.json")))["findings"][0];
    EXPECT_EQ(found["kind"], "reference");
    EXPECT_EQ(found["kernels"], json({"exposure"}));
    EXPECT_EQ(found["pixel"], json({5, 4}));
    EXPECT_EQ(found["channel"], "green");
    EXPECT_EQ(found["pixels"], 1);
    EXPECT_NE(found["smallest"]["look"].get<std::string>().find("exposure = 2"), std::string::npos);
    EXPECT_NE(app::summary_of(report).find("1 findings, in exposure"), std::string::npos);
}

}  // namespace
}  // namespace darkroom
