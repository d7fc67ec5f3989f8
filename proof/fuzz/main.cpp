// SPDX-License-Identifier: MIT
// fuzz_NAME [LIBFUZZER'S ARGUMENTS]: libFuzzer on the target NAME. All these names are links to one program, since what
// takes time and room is linking the libraries.
//   --seeds=FOLDER   writes the target's seeds into it instead
//   --words=FILE     writes what the effects and their parameters are called, as a dictionary

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <darkroom/effect.hpp>
#include <fstream>
#include <set>

#include "fuzz/target.hpp"

namespace darkroom::fuzz {
namespace {

const Target* chosen = nullptr;
// libFuzzer keeps what points into its arguments.
std::vector<std::string> arguments;
std::vector<char*> pointers;

void choose(std::string_view program) {
    const std::string name = std::filesystem::path(program).filename().string();
    for (const Target& target : targets())
        if (name == fmt::format("fuzz_{}", target.name)) chosen = &target;
    if (chosen != nullptr) return;
    fmt::print(stderr, "{}: start it by one of these names:", name);
    for (const Target& target : targets()) fmt::print(stderr, " fuzz_{}", target.name);
    fmt::print(stderr, "\n");
    std::exit(1);
}

void write_seeds(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    std::size_t count = 0;
    for (const std::string& seed : chosen->seeds()) {
        if (seed.size() > chosen->longest) continue;
        std::ofstream(folder / fmt::format("seed_{:04}", count++), std::ios::binary) << seed;
    }
    fmt::print("{}: {} seeds\n", chosen->name, count);
}

void write_words(const std::filesystem::path& path) {
    std::set<std::string> words;
    for (const EffectInfo* const effect : all_effects()) {
        words.emplace(effect->name);
        for (const ParamInfo& row : effect->parameters.rows) {
            words.emplace(row.name);
            for (const std::string_view choice : row.choices) words.emplace(choice);
        }
    }
    std::ofstream file(path);
    for (const std::string& word : words) file << fmt::format("\"{}\"\n", word);
}

}  // namespace
}  // namespace darkroom::fuzz

extern "C" int LLVMFuzzerInitialize(int* count, char*** values);
extern "C" int LLVMFuzzerInitialize(int* count, char*** values) {
    using namespace darkroom::fuzz;
    choose((*values)[0]);
    arguments.emplace_back((*values)[0]);
    // Before what was typed, which wins.
    arguments.push_back(fmt::format("-max_len={}", chosen->longest));
    arguments.push_back(fmt::format("-malloc_limit_mb={}", chosen->max_mebibytes));
    arguments.emplace_back("-timeout=10");
    for (int i = 1; i < *count; ++i) {
        const std::string_view argument = (*values)[i];
        const bool is_seeds = argument.starts_with("--seeds=");
        if (is_seeds) write_seeds(argument.substr(8));
        if (argument.starts_with("--words=")) write_words(argument.substr(8));
        if (is_seeds || argument.starts_with("--words=")) std::exit(0);
        arguments.emplace_back(argument);
    }
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    *count = static_cast<int>(pointers.size());
    pointers.push_back(nullptr);
    *values = pointers.data();
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace darkroom::fuzz;
    const std::string wrong = chosen->run({reinterpret_cast<const char*>(data), size});
    if (wrong.empty()) return 0;
    fmt::print(stderr, "{}: {}\n", chosen->name, wrong);
    std::abort();
}
