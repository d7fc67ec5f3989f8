// SPDX-License-Identifier: MIT
// Buffers in the frame graph: what orders their readers and writers, in a frame and from one to the next, and what is
// refused.
#include <gtest/gtest.h>

#include "graph/test_graphs.hpp"

namespace darkroom::graph::test {
namespace {

std::string why_refused(const Graph& graph) {
    const auto compiled = graph.compile(full_hd, measure);
    return compiled ? "" : compiled.error().text;
}

}  // namespace

TEST(GraphBuffer, CountsAreOrderedBetweenPassesAndBeforeTheNextFrame) {
    Graph graph;
    const Version fresh = graph.create_buffer("counts", 1024);
    const Version zero = graph.add({.name = "clear", .writes = {{fresh, Use::BufferWrite}}})[0];
    const Version counts = graph.add({.name = "count", .writes = {{zero, Use::BufferReadWrite}}})[0];
    graph.add({.name = "end", .reads = {{counts, Use::BufferReadFragment}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled) << compiled.error().text;
    EXPECT_EQ(compiled->transient_bytes(), 0u);
    EXPECT_EQ(compiled->buffer_bytes(), 1024u);
    Schedule schedule(*compiled);
    schedule.derive({}, {}, 0);
    EXPECT_EQ(trace(*compiled, schedule),
              "barrier counts: compute|fragment:store -> compute:store\n"
              "pass clear\n"
              "barrier counts: compute:store -> compute:load|store\n"
              "pass count\n"
              "barrier counts: compute:store -> fragment:load|uniform\n"
              "pass end\n");
    const auto checked = check(*compiled, schedule, {});
    EXPECT_TRUE(checked) << checked.error().text;
}

TEST(GraphBuffer, LastingOneKeepsItsContentWhereNobodyWritesIt) {
    Graph graph;
    const Version before = graph.lasting_buffer("value", 16);
    const Version after = graph.add({.name = "work out", .writes = {{before, Use::BufferReadWrite}}, .gate = 0})[0];
    graph.add({.name = "end", .reads = {{after, Use::BufferRead}}, .has_side_effect = true});
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled) << compiled.error().text;
    ASSERT_EQ(compiled->slots().size(), 1u);
    EXPECT_EQ(compiled->slots()[0].kind, Slot::Kind::Lasting);
    Schedule schedule(*compiled);
    for (const bool is_on : {true, false}) {
        schedule.derive({&is_on, 1}, {}, 0);
        EXPECT_EQ(schedule.steps().size(), is_on ? 2u : 1u);
        EXPECT_EQ(schedule.slot_of(after), 0u);
        const auto checked = check(*compiled, schedule, {});
        EXPECT_TRUE(checked) << checked.error().text;
    }
    EXPECT_EQ(schedule.barriers().size(), 0u) << "what a frame leaves is seen by the next";
}

TEST(GraphBuffer, WhatTheLastFrameLeftKeepsItsWriterAlive) {
    Graph graph;
    const Version before = graph.lasting_buffer("value", 16);
    graph.add({.name = "end", .reads = {{before, Use::BufferRead}}, .has_side_effect = true});
    static_cast<void>(graph.add({.name = "work out", .writes = {{before, Use::BufferWrite}}}));
    const auto compiled = graph.compile(full_hd, measure);
    ASSERT_TRUE(compiled) << compiled.error().text;
    Schedule schedule(*compiled);
    schedule.derive({}, {}, 0);
    EXPECT_EQ(schedule.steps().size(), 2u);
}

TEST(GraphBuffer, IsNoImage) {
    Graph graph;
    graph.add({.name = "a", .writes = {{graph.create_buffer("b", 16), Use::StorageWrite}}});
    EXPECT_EQ(why_refused(graph), "pass 'a' uses 'b' as an image, which is a buffer");
    Graph other;
    other.add({.name = "a", .reads = {{constant(other, "i"), Use::BufferRead}}, .has_side_effect = true});
    EXPECT_EQ(why_refused(other), "pass 'a' uses 'i' as a buffer, which is an image");
    Graph third;
    const Version black = constant(third, "black");
    const Version made = third.add({.name = "a", .writes = {{third.create_buffer("b", 16), Use::BufferWrite}}})[0];
    third.fall_back(made, black);
    EXPECT_EQ(why_refused(third), "'black' cannot stand in for 'b': one is a buffer, one an image");
}

TEST(GraphBuffer, ReadBeforeItIsWrittenIsAnError) {
    Graph graph;
    graph.add({.name = "a", .reads = {{graph.create_buffer("b", 16), Use::BufferRead}}, .has_side_effect = true});
    EXPECT_EQ(why_refused(graph), "pass 'a' reads 'b': declared, never written");
}

}  // namespace darkroom::graph::test
