// SPDX-License-Identifier: MIT
#include "baked.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <regex>

#include "child.hpp"
#include "core/files.hpp"

namespace darkroom::bench {

namespace {

namespace fs = std::filesystem;

Result<std::string> output_of(std::vector<std::string> arguments, const fs::path& log) {
    const std::string program = arguments.front();
    DARKROOM_TRY_VALUE(const auto ran, run_program(std::move(arguments), log));
    if (!ran.has_value()) return machine_error(fmt::format("{}: there is no such program", program));
    DARKROOM_TRY_VALUE(const auto bytes, read_file(log));
    const void* const text = bytes.data();
    return std::string(static_cast<const char*>(text), bytes.size());
}

/// Milliseconds of each round.
struct Rounds {
    std::vector<double> driver, beyond;
};
Result<Rounds> measure_in(const fs::path& folder, std::uint32_t rounds) {
    const std::string look = DARKROOM_SOURCE_FOLDER "/looks/documented.toml", kernels = folder / "kernels.dkb";
    const fs::path log = folder / "log";
    DARKROOM_TRY_VALUE(auto profile, output_of({DARKROOM_BAKED_HOST, "profile"}, log));
    profile.erase(profile.find_last_not_of('\n') + 1);
    DARKROOM_TRY(output_of({DARKROOM_PROGRAM, "bake", look, "-o", kernels, "--profile", profile, "--size", "256x144",
                            "--color-format", "R16G16B16A16_SFLOAT:storage", "--depth-format", "R32_SFLOAT:storage",
                            "--planar-depth", "--plain-velocity", "--target-format", "R8G8B8A8_UNORM:storage"},
                           log));
    Rounds out;
    for (std::uint32_t round = 0; round < rounds; ++round) {
        DARKROOM_TRY_VALUE(const auto said, output_of({DARKROOM_BAKED_HOST, look, "/dev/null", kernels}, log));
        static const std::regex line("([0-9.]+) of them [0-9]+ pipelines of the driver, ([0-9.]+) beyond");
        std::smatch match;
        if (!std::regex_search(said, match, line)) return machine_error("the host of baked kernels says no times");
        out.driver.push_back(std::stod(match[1]));
        out.beyond.push_back(std::stod(match[2]));
    }
    return out;
}

}  // namespace

Result<std::vector<Figure>> baked_figures(std::uint32_t rounds) {
    std::error_code error;
    const fs::path folder = fs::temp_directory_path(error) / fmt::format("darkroom_bench_baked_{}", getpid());
    fs::create_directories(folder, error);
    const auto measured = measure_in(folder, rounds);
    fs::remove_all(folder, error);
    if (!measured) return failure(measured.error());
    return std::vector<Figure>{
        {"baked: the driver's pipelines of the documented look", median(measured->driver), "ms"},
        {"baked: first record, beyond them", median(measured->beyond), "ms", 5},
    };
}

}  // namespace darkroom::bench
