// SPDX-License-Identifier: MIT
#include "develop/cost/kernel_cost.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace darkroom {

namespace {

KernelTable table_of(const KernelRow& row) {
    return {.driver = "radv 1", .rows = {{"bloom: bloom, compute, lean", row}}};
}

Result<KernelTable> read_text(const std::string& text) {
    const std::filesystem::path path = testing::TempDir() + "darkroom_kernel_table.txt";
    std::ofstream(path, std::ios::binary) << text;
    auto out = KernelTable::read(path);
    std::filesystem::remove(path);
    return out;
}

TEST(KernelTable, IsReadAsItWasWritten) {
    KernelTable table = table_of({.vgprs = 48, .waves = 10, .instructions = 419, .alu = 712, .texture = 424, .lds = 8});
    table.rows["a, raster, complete"] = {.vgprs = 8, .waves = 6.5, .spilled = 3};
    const auto read = read_text(table.text());
    ASSERT_TRUE(read) << read.error().text;
    EXPECT_EQ(read->driver, table.driver);
    EXPECT_EQ(read->text(), table.text());
    ASSERT_EQ(read->rows.size(), 2U);
    EXPECT_EQ(read->rows.at("a, raster, complete").waves, 6.5);
    EXPECT_EQ(read->rows.at("bloom: bloom, compute, lean").cycles(), 712);
}

TEST(KernelTable, DamagedOnesAreRefusedWithTheLine) {
    const std::string good = table_of({.alu = 1}).text();
    for (const char* const line : {"x", "1 2 3 4 5 6", "1 2 3 4 5 6 7", "1 2 3 4 5 6 7 name", ""}) {
        const auto read = read_text(good + line + "\n");
        ASSERT_FALSE(read) << line;
        EXPECT_NE(read.error().text.find(":4: not a line of a kernel table"), std::string::npos) << read.error().text;
    }
    EXPECT_FALSE(read_text(good + good.substr(good.rfind("  bloom") - 56))) << "one kernel twice";
    EXPECT_FALSE(KernelTable::read("/nonexistent/table.txt"));
}

TEST(KernelTable, FindsWhatSpillsGotDearerOrIsNew) {
    const KernelTable before = table_of({.alu = 100, .texture = 50});
    EXPECT_TRUE(findings(before, table_of({.alu = 110, .texture = 110})).empty()) << "a tenth is allowed";
    EXPECT_EQ(findings(before, table_of({.alu = 111})),
              (std::vector<std::string>{"bloom: bloom, compute, lean: 111 cycles, 100 before"}));
    EXPECT_EQ(findings(before, table_of({.alu = 50, .texture = 111})).size(), 1U) << "whatever it is that bounds it";
    EXPECT_EQ(findings(before, table_of({.alu = 100, .spilled = 1})),
              (std::vector<std::string>{"bloom: bloom, compute, lean: it spills registers"}));
    EXPECT_EQ(findings({.driver = before.driver, .rows = {}}, before),
              (std::vector<std::string>{"bloom: bloom, compute, lean: not in the table"}));
    EXPECT_TRUE(findings(before, {.driver = before.driver, .rows = {}}).empty()) << "an effect may be taken out";
}

TEST(KernelTable, AnotherDriversCostsSayNothing) {
    KernelTable now = table_of({.alu = 1000});
    now.driver = "radv 2";
    EXPECT_TRUE(findings(table_of({.alu = 100}), now).empty());
    now.rows.begin()->second.spilled = 1;
    EXPECT_EQ(findings(table_of({.alu = 100}), now).size(), 1U) << "spills do";
}

}  // namespace

}  // namespace darkroom
