// SPDX-License-Identifier: MIT
#include "develop/cost/machine_code.hpp"

#include <gtest/gtest.h>

#include "develop/cost/kernel_cost.hpp"

namespace darkroom {

namespace {

constexpr std::string_view counted = R"(BB0:
	s_mov_b32 s12, 1                                            ; be8c0381
	s_mov_b32 s13, 16                                           ; be8d0390
BB2:
	s_cmp_lt_i32 s13, s12                                       ; bf040c0d
	s_cbranch_scc1 BB6                                          ; bf850030
BB5:
	s_clause 0x1                                                ; bfa10001
	image_sample_lz v[8:11], v[2:3], s[24:31], s[20:23] dmask:0xf dim:SQ_RSRC_IMG_2D ; f09c0f08
	v_fmac_f32_e32 v8, v12, v15                                 ; 56101f0c
	s_add_u32 s12, s12, 1                                       ; 800c810c
	s_branch BB2                                                ; bf82ffe0
BB6:
	s_endpgm                                                    ; bf810000
)";

KernelStatistics with_code(std::string_view code) { return {.subgroup = 64, .machine_code = std::string(code)}; }

std::string replaced(std::string_view text, std::string_view old, std::string_view by) {
    std::string out(text);
    return out.replace(out.find(old), old.size(), by);
}

TEST(MachineCode, ReadsInstructionsAndOperands) {
    const MachineCode code(counted);
    ASSERT_EQ(code.instructions().size(), 10U);
    EXPECT_EQ(code.instructions()[2].name, "s_cmp_lt_i32");
    EXPECT_EQ(code.instructions()[2].operands, (std::vector<std::string_view>{"s13", "s12"}));
    ASSERT_EQ(code.loops().size(), 1U);
    EXPECT_EQ(code.loops()[0].begin, 2U);
    EXPECT_EQ(code.loops()[0].end, 8U);
}

TEST(MachineCode, RunsACounterToItsEnd) {
    EXPECT_EQ(MachineCode(counted).trips({2, 8}), 16U);
    const std::string by_three = replaced(counted, "s_add_u32 s12, s12, 1", "s_addk_i32 s12, 0x3");
    EXPECT_EQ(MachineCode(by_three).trips({2, 8}), 6U) << "1, 4, 7, 10, 13, 16";
    const std::string downwards =
        replaced(replaced(counted, "s_cmp_lt_i32 s13, s12", "s_cmp_gt_i32 -7, s12"), "s12, s12, 1", "s12, s12, -2");
    EXPECT_EQ(MachineCode(downwards).trips({2, 8}), 5U) << "1, -1, -3, -5, -7";
}

TEST(MachineCode, CountsALoopThatEndsAtItsEnd) {
    constexpr std::string_view code = R"(BB0:
	s_movk_i32 s2, 0x0
BB1:
	v_add_f32_e32 v0, v0, v1
	s_add_i32 s2, s2, 1
	s_cmp_lt_u32 s2, 5
	s_cbranch_scc1 BB1
BB2:
	s_endpgm
)";
    const MachineCode read(code);
    ASSERT_EQ(read.loops().size(), 1U);
    EXPECT_EQ(read.trips(read.loops()[0]), 5U);
}

TEST(MachineCode, DoesNotKnowWhatIsLoadedOrDependsOnPixels) {
    const std::string loaded = replaced(counted, "s_mov_b32 s13, 16", "s_buffer_load_dwordx2 s[12:13], s[8:11], 0x70");
    EXPECT_FALSE(MachineCode(loaded).trips({2, 8}));
    const std::string overwritten = replaced(counted, "s_clause 0x1", "s_load_dwordx8 s[8:15], s[2:3], 0x20");
    EXPECT_FALSE(MachineCode(overwritten).trips({2, 8}));
    const std::string by_pixel =
        replaced(replaced(counted, "s_cmp_lt_i32 s13, s12", "v_cmpx_ngt_f32_e32 s16, v10"), "scc1", "execz");
    EXPECT_FALSE(MachineCode(by_pixel).trips({2, 8}));
}

TEST(MachineCode, TakesAnyText) {
    for (const std::string_view text :
         {"", "BB", "BB1:", ";", "s_branch", "s_branch BB1", "BB1:\ns_branch BB1", "BB1:\ns_cmp_lt_i32\ns_branch BB1",
          "x s[", "x s[1", "x s[:]\ns_mov_b32 s[, 1", "s_mov_b32 s1, 99999999999999999999"}) {
        const MachineCode code(text);
        for (const MachineCode::Loop& loop : code.loops()) EXPECT_FALSE(code.trips(loop)) << text;
        EXPECT_FALSE(kernel_cost(with_code(text), Architecture::Rdna)) << text;
    }
}

TEST(KernelCost, CountsEachUnitWithTheRoundsOfItsLoop) {
    const auto cost = kernel_cost(with_code(counted), Architecture::Rdna);
    ASSERT_TRUE(cost);
    EXPECT_EQ(cost->texture, 16 * 32);
    EXPECT_EQ(cost->alu, 2 + 16 * 4) << "scalar: two moves; comparison, branch, addition, branch a round";
    EXPECT_EQ(cost->cycles(), cost->texture);
    EXPECT_EQ(cost->bound(), "texture");
    ASSERT_EQ(cost->loops.size(), 1U);
    EXPECT_TRUE(cost->loops[0].is_known);
    const auto on_gcn = kernel_cost(with_code(counted), Architecture::Gcn);
    ASSERT_TRUE(on_gcn);
    EXPECT_EQ(on_gcn->texture, 2 * cost->texture);
    EXPECT_EQ(on_gcn->alu, 4 * cost->alu) << "four SIMDs share a scalar unit";
}

TEST(KernelCost, GuessesWhatItDoesNotKnowAndSaysSo) {
    const std::string loaded = replaced(counted, "s_mov_b32 s13, 16", "s_load_dword s13, s[2:3], 0x20");
    const auto cost = kernel_cost(with_code(loaded), Architecture::Rdna);
    ASSERT_TRUE(cost);
    EXPECT_EQ(cost->texture, 8 * 32);
    EXPECT_FALSE(cost->loops.at(0).is_known);
    const auto told = kernel_cost(with_code(loaded), Architecture::Rdna, std::array{3.0});
    ASSERT_TRUE(told);
    EXPECT_EQ(told->texture, 3 * 32);
    EXPECT_TRUE(told->loops.at(0).is_known);
}

TEST(KernelCost, GuessesLessOfInnerLoops) {
    constexpr std::string_view nested = R"(BB1:
	v_mov_b32 v0, v1
BB2:
	image_load v0, v1, s[0:7]
	s_cbranch_execnz BB2
BB3:
	s_branch BB1
BB4:
	image_load v0, v1, s[0:7]
	s_cbranch_execnz BB4
	s_endpgm
)";
    const auto cost = kernel_cost(with_code(nested), Architecture::Rdna);
    ASSERT_TRUE(cost);
    ASSERT_EQ(cost->loops.size(), 3U);
    EXPECT_EQ(cost->loops[0].trips, 8);
    EXPECT_EQ(cost->loops[1].trips, 4);
    EXPECT_EQ(cost->loops[2].trips, 8);
    EXPECT_EQ(cost->texture, (8 * 4 + 8) * 8);
}

TEST(KernelCost, KnowsTheSpeedsOfInstructions) {
    const auto alu_of = [](const std::string& line) {
        const auto cost = kernel_cost(with_code(line + "\ns_endpgm\n"), Architecture::Rdna);
        return cost ? cost->alu : -1;
    };
    EXPECT_EQ(alu_of("v_fma_f32 v0, v1, v2, v3"), 2);
    EXPECT_EQ(alu_of("v_rcp_f32_e32 v0, v1"), 8);
    EXPECT_EQ(alu_of("v_mul_lo_u32 v0, v1, v2"), 8);
    EXPECT_EQ(alu_of("v_add_f64 v[0:1], v[2:3], v[4:5]"), 32);
    EXPECT_EQ(alu_of("v_lshlrev_b64 v[0:1], 3, v[4:5]"), 4);
    EXPECT_EQ(alu_of("s_waitcnt vmcnt(0)"), 0);
    const auto lds = kernel_cost(with_code("ds_read_b128 v[0:3], v4\ns_endpgm\n"), Architecture::Rdna);
    ASSERT_TRUE(lds);
    EXPECT_EQ(lds->bound(), "LDS");
    EXPECT_EQ(lds->lds, 16);
}

TEST(KernelCost, MillisecondsAreOfTheSimdsOrOfTheMemory) {
    const Chip chip{.name = "", .family = "", .simds = 100, .gigahertz = 1, .gigabytes_per_second = 100};
    const KernelCost cost{.alu = 50};
    EXPECT_DOUBLE_EQ(milliseconds(cost, 64e6, 1, chip), 0.5) << "a million waves of 50 cycles on 100 SIMDs";
    EXPECT_DOUBLE_EQ(milliseconds(cost, 64e6, 1e8, chip), 1.0);
}

TEST(KernelCost, FamiliesAreReadFromNames) {
    EXPECT_EQ(amd_family("Null hardware (RADV NAVI21)"), "NAVI21");
    EXPECT_EQ(amd_family("AMD Radeon RX 6800 XT (RADV NAVI21)"), "NAVI21");
    EXPECT_EQ(amd_family("llvmpipe (LLVM 15.0.6, 256 bits)"), "");
    EXPECT_EQ(architecture_of("VEGA10"), Architecture::Gcn);
    for (const Chip& chip : chips()) EXPECT_EQ(architecture_of(chip.family), chip.architecture) << chip.name;
}

}  // namespace

}  // namespace darkroom
