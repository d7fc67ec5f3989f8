// SPDX-License-Identifier: MIT
// Passes that wait for none of each other run side by side, whoever declared them between. That a round needs no
// barrier within is what the checker says of random graphs (random_test.cpp).
#include <gtest/gtest.h>

#include <array>

#include "graph/solution.hpp"
#include "graph/test_graphs.hpp"

namespace darkroom::graph::test {
namespace {

/// Adds a pass that reads `from` and makes an image of its own name.
Version add_step(Graph& graph, const std::string& name, Version from, Use use = Use::SampledCompute) {
    return graph.add(
        {.name = name, .reads = {{from, use}}, .writes = {{graph.create(image(name)), Use::StorageWrite}}})[0];
}

std::string rounds_text(const Compiled& compiled) {
    std::string out;
    for (std::size_t i = 0; i < compiled.passes().size(); ++i) {
        const bool is_next = i > 0 && compiled.rounds()[i] != compiled.rounds()[i - 1];
        out += (i == 0 ? "" : is_next ? " | " : ", ") + compiled.passes()[i].name;
    }
    return out;
}

std::string rounds_text(const Graph& graph) {
    const auto compiled = graph.compile(full_hd, measure);
    return compiled ? rounds_text(*compiled) : compiled.error().text;
}

}  // namespace

TEST(GraphRounds, ChainsThatShareNothingRunSideBySide) {
    Graph graph;
    const Version color = host_image(graph, "color");
    const Version a2 = add_step(graph, "a2", add_step(graph, "a1", add_step(graph, "a0", color)));
    const Version b1 = add_step(graph, "b1", add_step(graph, "b0", color));
    graph.add(
        {.name = "join", .reads = {{a2, Use::SampledCompute}, {b1, Use::SampledCompute}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled);
    EXPECT_EQ(rounds_text(*compiled), "a0, b0 | a1, b1 | a2 | join");

    Schedule schedule(*compiled);
    const std::array imports{host_state(VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL)};
    schedule.derive({}, imports, 0);
    std::vector<bool> waits;
    for (const Step& step : schedule.steps()) waits.push_back(step.barrier_count > 0);
    EXPECT_EQ(waits, (std::vector<bool>{true, false, true, false, true, true}));
}

TEST(GraphRounds, WhoWritesAgainWaitsForThoseWhoRead) {
    Graph graph;
    const Version first = add_step(graph, "write", host_image(graph, "color"));
    graph.add({.name = "read", .reads = {{first, Use::SampledCompute}}, .has_side_effect = true});
    const Version second = graph.add({.name = "write again", .writes = {{first, Use::StorageReadWrite}}})[0];
    graph.add({.name = "end", .reads = {{second, Use::SampledCompute}}, .has_side_effect = true});
    EXPECT_EQ(rounds_text(graph), "write | read | write again | end");
}

TEST(GraphRounds, ReadersInTwoLayoutsWaitForEachOther) {
    Graph graph;
    const Version made = add_step(graph, "write", host_image(graph, "color"));
    graph.add({.name = "sample", .reads = {{made, Use::SampledCompute}}, .has_side_effect = true});
    graph.add({.name = "load", .reads = {{made, Use::StorageRead}}, .has_side_effect = true});
    graph.add({.name = "load, too", .reads = {{made, Use::StorageRead}}, .has_side_effect = true});
    graph.add({.name = "sample again", .reads = {{made, Use::SampledCompute}}, .has_side_effect = true});
    EXPECT_EQ(rounds_text(graph), "write | sample | load, load, too | sample again");
}

TEST(GraphRounds, ImagesOfOneRoundShareNoMemory) {
    Graph graph;
    const Version color = host_image(graph, "color");
    const Version a = add_step(graph, "a1", add_step(graph, "a0", color));
    const Version b = add_step(graph, "b1", add_step(graph, "b0", color));
    graph.add({.name = "join", .reads = {{a, Use::SampledCompute}, {b, Use::SampledCompute}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled);
    EXPECT_EQ(compiled->transient_bytes(), compiled->transient_bytes_unaliased())
        << "a0 and b0 are read while a1 and b1 are written";
}

}  // namespace darkroom::graph::test
