// SPDX-License-Identifier: MIT
// Every target of the fuzzers once over its seeds and the cases that were kept, whatever the compiler.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <filesystem>

#include "fuzz/target.hpp"

namespace darkroom::fuzz {
namespace {

class Fuzz : public testing::TestWithParam<Target> {};

TEST_P(Fuzz, SeedsAndKeptCasesBreakNoPromise) {
    const Target& target = GetParam();
    std::vector<std::string> inputs = target.seeds();
    std::erase_if(inputs, [&](const std::string& seed) { return seed.size() > target.longest; });
    EXPECT_FALSE(inputs.empty());
    // Cut short, they are read to where they end.
    for (std::size_t i = 0, count = inputs.size(); i < count; ++i)
        inputs.push_back(inputs[i].substr(0, inputs[i].size() / 2));
    for (std::string& kept : files(fmt::format("proof/fuzz/cases/{}/*", target.name)))
        inputs.push_back(std::move(kept));
    inputs.emplace_back();
    for (const std::string& input : inputs) {
        const std::string wrong = target.run(input);
        EXPECT_TRUE(wrong.empty()) << wrong.substr(0, 2000) << "\n" << testing::PrintToString(input.substr(0, 1000));
    }
}

INSTANTIATE_TEST_SUITE_P(, Fuzz, testing::ValuesIn(targets()),
                         [](const testing::TestParamInfo<Target>& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace darkroom::fuzz
