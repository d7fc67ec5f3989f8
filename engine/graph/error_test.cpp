// SPDX-License-Identifier: MIT
// What compile() refuses, and the words it uses: every message names the pass, the image, and the other end.
#include <gtest/gtest.h>

#include "graph/test_graphs.hpp"

namespace darkroom::graph::test {
namespace {

std::string error_of(const Graph& graph, VkExtent2D extent = full_hd, const Measure& measured = measure) {
    const auto compiled = graph.compile(extent, measured);
    return compiled ? "no error" : compiled.error().text;
}

Version write(Graph& graph, std::string name, Version version, Use use = Use::StorageWrite, std::int32_t gate = -1) {
    return graph.add({.name = std::move(name), .writes = {{version, use}}, .gate = gate})[0];
}
void read(Graph& graph, std::string name, Version version, Use use = Use::SampledCompute, MipRange mips = {}) {
    graph.add({.name = std::move(name), .reads = {{version, use, mips}}, .has_side_effect = true});
}

}  // namespace

TEST(GraphError, ReadAfterOverwrite) {
    Graph graph;
    const Version first = write(graph, "a", graph.create(image("x")));
    write(graph, "c", first);
    read(graph, "b", first);
    EXPECT_EQ(error_of(graph), "pass 'b' reads 'x' (version written by 'a') after pass 'c' overwrote it");
}

TEST(GraphError, WriteAfterOverwrite) {
    Graph graph;
    const Version first = host_image(graph, "x");
    write(graph, "a", first);
    write(graph, "b", first);
    EXPECT_EQ(error_of(graph), "pass 'b' writes 'x' (version written by the host) after pass 'a' overwrote it");
}

TEST(GraphError, TwoWritesInOnePass) {
    Graph graph;
    const Version pyramid = graph.create(image("x", 2));
    graph.add({.name = "a", .writes = {{pyramid, Use::StorageWrite, {0, 1}}, {pyramid, Use::StorageWrite, {1, 1}}}});
    EXPECT_EQ(error_of(graph), "pass 'a' writes 'x' twice: one write with one mip range is allowed");
}

TEST(GraphError, NeverWritten) {
    Graph graph;
    read(graph, "b", graph.create(image("x")));
    EXPECT_EQ(error_of(graph), "pass 'b' reads 'x': declared, never written");
}

TEST(GraphError, BlendOverNothing) {
    Graph graph;
    write(graph, "b", graph.create(image("x")), Use::ColorBlend);
    EXPECT_EQ(error_of(graph), "pass 'b' reads 'x': declared, never written");
}

TEST(GraphError, LevelNeverWritten) {
    Graph graph;
    const Version made =
        graph.add({.name = "a", .writes = {{graph.create(image("x", 3)), Use::StorageWrite, {0, 2}}}})[0];
    read(graph, "b", made);
    EXPECT_EQ(error_of(graph), "pass 'b' reads 'x', mip level 2: declared, never written");
}

TEST(GraphError, CurrentHistoryReadBeforeItIsWritten) {
    Graph graph;
    read(graph, "b", graph.history(image("x")).current);
    EXPECT_EQ(error_of(graph), "pass 'b' reads 'x': declared, never written");
}

TEST(GraphError, PreviousHistoryThatNobodyWrites) {
    Graph graph;
    read(graph, "b", graph.history(image("x")).previous);
    EXPECT_EQ(error_of(graph), "pass 'b' reads the previous 'x', but no pass writes the current one");
}

TEST(GraphError, WriteToPreviousHistoryOrConstant) {
    Graph graph;
    write(graph, "b", graph.history(image("x")).previous);
    EXPECT_EQ(error_of(graph), "pass 'b' writes 'x', which is the last frame's history: reading is allowed");
    Graph other;
    write(other, "b", constant(other, "black"));
    EXPECT_EQ(error_of(other), "pass 'b' writes 'black', which is constant: reading is allowed");
}

TEST(GraphError, GateWithoutFallBack) {
    Graph graph;
    const Version made = write(graph, "a", graph.create(image("x")), Use::StorageWrite, 0);
    read(graph, "b", made);
    EXPECT_EQ(error_of(graph),
              "pass 'b' reads 'x', but pass 'a' that writes it may be off: it needs a fall-back, or the same gate");
}

TEST(GraphError, FallBackThatMayBeOffItself) {
    Graph graph;
    const Version other = write(graph, "z", graph.create(image("y")), Use::StorageWrite, 1);
    const Version made = write(graph, "a", graph.create(image("x")), Use::StorageWrite, 0);
    graph.fall_back(made, other);
    read(graph, "b", made);
    EXPECT_EQ(error_of(graph),
              "pass 'b' reads 'y', but pass 'z' that writes it may be off: it needs a fall-back, or the same gate");
}

TEST(GraphError, FallBackThatIsOffAtTheSameTime) {
    Graph graph;
    const Version other = write(graph, "z", graph.create(image("y")), Use::StorageWrite, 0);
    const Version made = write(graph, "a", graph.create(image("x")), Use::StorageWrite, 0);
    graph.fall_back(made, other);
    read(graph, "b", made);
    EXPECT_EQ(error_of(graph),
              "pass 'b' reads 'y', but pass 'z' that writes it may be off: it needs a fall-back, or the same gate");
}

TEST(GraphError, FallBackIsNeededOnlyByOtherGates) {
    Graph graph;
    const Version made = write(graph, "a", graph.create(image("x")), Use::StorageWrite, 0);
    graph.add({.name = "b", .reads = {{made, Use::SampledCompute}}, .has_side_effect = true, .gate = 0});
    EXPECT_EQ(error_of(graph), "no error");
}

TEST(GraphError, FallBackCycle) {
    Graph graph;
    const Version first = write(graph, "a", graph.create(image("x")), Use::StorageWrite, 0);
    const Version second = write(graph, "b", graph.create(image("y")), Use::StorageWrite, 1);
    graph.fall_back(first, second);
    graph.fall_back(second, first);
    EXPECT_EQ(error_of(graph), "fall-backs form a cycle: 'x' -> 'y' -> 'x'");
}

TEST(GraphError, OwnFallBackIsEnough) {
    Graph graph;
    const Version black = constant(graph, "black");
    const Version made = write(graph, "a", graph.create(image("x")), Use::StorageWrite, 0);
    graph.add({.name = "b", .reads = {{.version = made, .instead = black}}, .has_side_effect = true});
    EXPECT_EQ(error_of(graph), "no error");
    read(graph, "c", made);
    EXPECT_EQ(error_of(graph),
              "pass 'c' reads 'x', but pass 'a' that writes it may be off: it needs a fall-back, or the same gate");
}

TEST(GraphError, OwnFallBackThatMayBeOffItself) {
    Graph graph;
    const Version other = write(graph, "z", graph.create(image("y")), Use::StorageWrite, 1);
    const Version made = write(graph, "a", graph.create(image("x")), Use::StorageWrite, 0);
    graph.fall_back(made, constant(graph, "black"));
    graph.add({.name = "b", .reads = {{.version = made, .instead = other}}, .has_side_effect = true});
    EXPECT_EQ(error_of(graph),
              "pass 'b' reads 'y', but pass 'z' that writes it may be off: it needs a fall-back, or the same gate");
}

TEST(GraphError, OwnFallBackThatLeadsBack) {
    Graph graph;
    const Version first = write(graph, "a", graph.create(image("x")), Use::StorageWrite, 0);
    const Version second = write(graph, "z", graph.create(image("y")), Use::StorageWrite, 1);
    graph.fall_back(second, first);
    graph.fall_back(first, constant(graph, "black"));
    graph.add({.name = "b", .reads = {{.version = first, .instead = second}}, .has_side_effect = true});
    EXPECT_EQ(error_of(graph), "fall-backs of pass 'b' form a cycle: 'x' -> 'y' -> 'x'");
}

TEST(GraphError, OwnFallBackThatLeadsToAnOlderVersion) {
    Graph graph;
    const Version first = write(graph, "a", graph.create(image("x")), Use::StorageWrite, 1);
    const Version second = write(graph, "z", first, Use::ColorBlend, 1);
    const Version side = write(graph, "s", graph.create(image("y")), Use::StorageWrite, 0);
    graph.fall_back(side, first);
    graph.fall_back(first, constant(graph, "black"));
    graph.add({.name = "b", .reads = {{.version = second, .instead = side}}, .has_side_effect = true});
    EXPECT_EQ(error_of(graph), "fall-backs of pass 'b' form a cycle: 'x' -> 'y' -> 'x'");
}

TEST(GraphError, OwnFallBackThatDoesNotExist) {
    Graph graph;
    const Version made = write(graph, "a", graph.create(image("x")));
    graph.add({.name = "b", .reads = {{.version = made, .instead = {99}}}, .has_side_effect = true});
    EXPECT_EQ(error_of(graph), "pass 'b' reads 'x', or a version that does not exist");
}

TEST(GraphError, OneKeyOfTwoHistories) {
    Graph graph;
    (void)graph.history(image("x"), {.owner = 3, .number = 1});
    (void)graph.history(image("y"), {.owner = 3, .number = 0});
    (void)graph.history(image("z"));
    (void)graph.history(image("z"));
    EXPECT_EQ(error_of(graph), "no error");
    (void)graph.history(image("w"), {.owner = 3, .number = 1});
    EXPECT_EQ(error_of(graph), "the histories 'x' and 'w' have the same key 3.1: one a history is allowed");
}

TEST(GraphError, FallBackOverwrittenBeforeTheReader) {
    Graph graph;
    const Version color = host_image(graph, "color");
    const Version made = graph.add({.name = "a",
                                    .reads = {{color, Use::SampledCompute}},
                                    .writes = {{graph.create(image("x")), Use::StorageWrite}},
                                    .gate = 0})[0];
    graph.fall_back(made, color);
    write(graph, "c", color);
    read(graph, "b", made);
    EXPECT_EQ(error_of(graph),
              "pass 'b' reads 'color' (instead of 'x' while pass 'a' is off) after pass 'c' overwrote it");
}

TEST(GraphError, FallBackWrittenAfterTheReader) {
    Graph graph;
    const Version made = write(graph, "a", graph.create(image("x")), Use::StorageWrite, 0);
    read(graph, "b", made);
    graph.fall_back(made, write(graph, "c", graph.create(image("late"))));
    EXPECT_EQ(error_of(graph), "pass 'b' reads 'late' (instead of 'x' while pass 'a' is off) before pass 'c' wrote it");
}

TEST(GraphError, BlendOverAFallBack) {
    Graph graph;
    const Version black = constant(graph, "black");
    const Version made = write(graph, "a", graph.create(image("x")), Use::ColorWrite, 0);
    graph.fall_back(made, black);
    write(graph, "b", made, Use::ColorBlend);
    EXPECT_EQ(
        error_of(graph),
        "pass 'b' keeps the content of 'x', but pass 'a' that writes it may be off: another image cannot stand in "
        "for it");
}

TEST(GraphError, KeptHostImageWithAFallBack) {
    Graph graph;
    const Version color = host_image(graph, "color");
    const Version made = write(graph, "a", host_image(graph, "target"), Use::StorageWrite, 0);
    graph.keep(made);
    EXPECT_EQ(error_of(graph), "'target' is kept, but pass 'a' that writes it may be off: it needs a fall-back");
    graph.fall_back(made, color);
    EXPECT_EQ(error_of(graph),
              "'target' is kept, but pass 'a' that writes it may be off: another image cannot stand in for the host's");
}

TEST(GraphError, KeptVersionIsOverwritten) {
    Graph graph;
    const Version first = write(graph, "a", host_image(graph, "target"));
    graph.keep(first);
    write(graph, "b", first);
    EXPECT_EQ(error_of(graph), "'target' is kept, but pass 'b' overwrites that version");
}

TEST(GraphError, HostImageOfTheWrongUsage) {
    Graph graph;
    const Version color = graph.import({.image = image("color"), .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
    graph.keep(write(graph, "a", color));
    EXPECT_EQ(error_of(graph), "pass 'a' uses the host's image 'color' as STORAGE, but it was created for SAMPLED");
}

TEST(GraphError, OnePassReadsInTwoLayouts) {
    Graph graph;
    const Version color = host_image(graph, "color");
    graph.add(
        {.name = "b", .reads = {{color, Use::SampledCompute}, {color, Use::StorageRead}}, .has_side_effect = true});
    EXPECT_EQ(error_of(graph), "pass 'b' reads 'color' in two ways that need different layouts");
}

TEST(GraphError, OnePassReadsAndWritesALevel) {
    Graph graph;
    const Version color = host_image(graph, "color");
    graph.add({.name = "b", .reads = {{color, Use::StorageRead}}, .writes = {{color, Use::StorageWrite}}});
    EXPECT_EQ(error_of(graph),
              "pass 'b' reads 'color' and writes the same mip level: StorageReadWrite or ColorBlend do both");
}

TEST(GraphError, MipLevels) {
    Graph flat, many, outside;
    (void)flat.create(image("x", 0));
    EXPECT_EQ(error_of(flat), "image 'x' of 1920x1080 has 0 mip levels: 1 to 11 are allowed");
    (void)many.create(image("x", 12));
    EXPECT_EQ(error_of(many), "image 'x' of 1920x1080 has 12 mip levels: 1 to 11 are allowed");
    const Version made = write(outside, "a", outside.create(image("x", 3)));
    read(outside, "b", made, Use::SampledCompute, {2, 2});
    EXPECT_EQ(error_of(outside), "pass 'b' reads 2 mip levels of 'x' from level 2 on, which has 3");
}

TEST(GraphError, Sizes) {
    Graph graph;
    (void)graph.create({.name = "x", .size = Size::fraction(0)});
    EXPECT_EQ(error_of(graph), "image 'x' has the size 1/0 of the frame: both must be at least 1");
    EXPECT_EQ(error_of(Graph(), {0, 4}), "the largest frame is 0x4: at least 1x1 is needed");
}

TEST(GraphError, UseOfTheWrongKind) {
    Graph reads, writes, unknown;
    read(reads, "b", host_image(reads, "x"), Use::StorageWrite);
    EXPECT_EQ(error_of(reads), "pass 'b' reads 'x' with a use that writes");
    write(writes, "b", host_image(writes, "x"), Use::SampledCompute);
    EXPECT_EQ(error_of(writes), "pass 'b' writes 'x' with a use that only reads");
    read(unknown, "b", Version{});
    EXPECT_EQ(error_of(unknown), "pass 'b' reads a version that does not exist");
}

TEST(GraphError, NoMemoryTypeForAll) {
    Graph graph;
    read(graph, "b", write(graph, "a", graph.create(image("x"))));
    read(graph, "d", write(graph, "c", graph.create(image("y"))));
    const Measure apart = [](const ImageDesc& desc, VkImageUsageFlags, const Extents&) -> Result<Requirements> {
        return Requirements{.size = 16, .alignment = 1, .memory_type_bits = desc.name == "x" ? 1u : 2u};
    };
    EXPECT_EQ(error_of(graph, full_hd, apart),
              "image 'y' accepts the memory types 0x2: none of them suits the other transient images as well");
}

}  // namespace darkroom::graph::test
