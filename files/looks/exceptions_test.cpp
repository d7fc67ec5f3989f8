// SPDX-License-Identifier: MIT
// No exception leaves a function of looks that returns a Result: it becomes an error.

#include <gtest/gtest.h>

#include <darkroom/look.hpp>
#include <filesystem>
#include <fstream>

#include "core/test_support_failing.hpp"
#include "gpu/test_support.hpp"

namespace darkroom {
namespace {

using test::with_each_allocation_failing;

TEST(LookExceptions, EveryAllocationOfEveryFunctionMayFail) {
    if (!test::counts_allocations()) GTEST_SKIP() << "this build has its own operator new";
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "darkroom_look_exceptions";
    std::filesystem::create_directories(folder);
    const auto file = [&](const char* name, const std::string& text) {
        std::ofstream(folder / name) << text;
        return folder / name;
    };
    const std::string text =
        "[post_process]\norder = \"scene_linear\"\nexposure = 1.5\nvignette_intensity = 0.3\nnothing = 1\n"
        "[ui]\nui_warp_strength = 0.1\ngame = { health = 20.0, name = \"a name that is long enough\" }\n"
        "[[pulse]]\nevent = \"hit\"\nparameter = \"vignette.intensity\"\namount = 0.4\nenvelope = "
        "\"exponential\"\nduration = 0.5\n"
        "[[layer]]\nname = \"a_layer_with_a_long_name\"\nvalues = { exposure = 2.0 }\n";
    const std::string mine =
        "// @effect mine: Mine.\n// @param float a = 1 in [0, 1]: One.\n"
        "vec4 mine(vec4 color, Pixel pixel, Mine parameters) { return color; }\n";
    const auto look_file = file("look.toml", text), laid = file("laid.toml", "[post_process]\nexposure = 2\n"),
               effect = file("mine.glsl", mine);
    const Look look = gpu::test::must(parse_look(text, "look.toml"));
    const Look other = gpu::test::must(parse_look("[post_process]\nfog_density = 0.2\n", "other.toml"));
    const std::vector<LookOverride> overrides{{"bloom_intensity", "0.25", "--bloom-intensity"},
                                              {"vignette.intensity", "0.5", "--set"}};
    const LookEntry entry = gpu::test::must(custom_entry(effect));
    const Device device = Device::assumed();

    with_each_allocation_failing("parse_look", [&] { return parse_look(text, "look.toml").has_value(); });
    with_each_allocation_failing("read_look", [&] { return read_look(look_file).has_value(); });
    with_each_allocation_failing("custom_entry", [&] { return custom_entry(effect).has_value(); });
    // Arguments are the caller's own matter.
    const auto with_each_failing_on = [&](const char* name, const auto& call) {
        Look changed = look;
        with_each_allocation_failing(name, [&] { return call(changed).has_value(); });
    };
    with_each_failing_on("override_look", [&](Look& changed) { return override_look(changed, overrides); });
    with_each_failing_on("lay_over", [&](Look& changed) { return lay_over(changed, laid); });
    Composer composer(device);
    with_each_allocation_failing("apply", [&] { return apply(look, composer).has_value(); });
    Composer followed(device);
    gpu::test::must(apply(look, followed));
    with_each_allocation_failing("follow", [&] { return follow(look, other, followed).has_value(); });
    for (std::uint64_t number = 0;; ++number) {
        Look changed = look;
        LookEntry placed = entry;
        const test::FailingAllocation failing(number);
        EXPECT_NO_THROW(static_cast<void>(place_entry(changed, std::move(placed)))) << number;
        if (!failing.has_failed()) break;
    }
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace darkroom
