// SPDX-License-Identifier: MIT
// Every Vulkan call of a sequence that is developed fails once: two frames on the device at a time, then another size.
#include <darkroom/effects.hpp>

#include "develop/developer.hpp"
#include "gpu/test_failing/attempts.hpp"

namespace darkroom {
namespace {

using gpu::test::Attempt;

struct DevelopedFrame {
    explicit DevelopedFrame(VkExtent2D size, float number) : extent(size) {
        const std::size_t pixels = std::size_t{extent.width} * extent.height;
        for (std::size_t i = 0; i < pixels * 4; ++i)
            color.push_back(i % 4 == 3 ? 1.0f : static_cast<float>(i % 101) / 40.0f + number);
        depth.assign(pixels, 5.0f);
    }
    [[nodiscard]] DevelopInput input() const { return {.extent = extent, .color = color, .depth = depth}; }
    VkExtent2D extent;
    std::vector<float> color, depth;
};

class DevelopCalls : public ::testing::Test {
  protected:
    void SetUp() override {
        for (const char* const name : {"bloom", "depth_of_field", "tonemap", "encode"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
    }
    /// A frame that failed is submitted once more, behind what is under way.
    std::vector<std::byte> sequence(Attempt& attempt) const {
        std::vector<std::byte> out;
        auto device = attempt("adopting", [&] { return attempt.adopted(gpu::test::device()); });
        if (!device) return out;
        Composer composer(*device, {.frames_in_flight = 2, .max_threads = 0});
        for (const char* const name : {"bloom", "depth_of_field", "tonemap", "encode"})
            composer.add(*find_effect(name), nullptr);
        Developer developer(*device, {.frames_in_flight = 2});
        std::vector<std::size_t> under_way;
        const auto submit = [&](std::size_t i) {
            return attempt("submitting", [&] { return developer.submit(composer, frames_[i].input()); }).has_value();
        };
        const auto finish = [&]() -> bool {
            const std::size_t i = under_way.front();
            under_way.erase(under_way.begin());
            auto done = developer.finish();
            if (!done) {
                attempt.expect_told("finishing", done.error());
                done = attempt("once more", [&]() -> Result<DevelopedPicture> {
                    if (developer.in_flight() > 0) static_cast<void>(developer.finish());
                    return developer.develop(composer, frames_[i].input());
                });
                // What was under way behind it came out of the way.
                for (const std::size_t behind : under_way)
                    if (!submit(behind)) return false;
            }
            if (!done) return false;
            const auto bytes = std::as_bytes(std::span(done->bytes));
            out.insert(out.end(), bytes.begin(), bytes.end());
            return true;
        };
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            if (developer.in_flight() == 2 && !finish()) return out;
            if (i > 0 && frames_[i].extent.width != frames_[i - 1].extent.width)
                while (!under_way.empty())
                    if (!finish()) return out;
            if (!submit(i)) return out;
            under_way.push_back(i);
        }
        while (!under_way.empty())
            if (!finish()) return out;
        return out;
    }

  private:
    const std::vector<DevelopedFrame> frames_{DevelopedFrame({40, 24}, 0), DevelopedFrame({40, 24}, 0.5f),
                                              DevelopedFrame({40, 24}, 1), DevelopedFrame({57, 31}, 0.25f)};
};

class GpuFailedDevelop : public DevelopCalls {};
class SoakFailedDevelop : public DevelopCalls {};

TEST_F(GpuFailedDevelop, BySeed) {
    const gpu::test::Points points = gpu::test::try_each_call([&](Attempt& attempt) { return sequence(attempt); }, 4);
    fmt::print("a sequence: {} calls that may fail, {} points tried\n", points.calls, points.tried);
}
TEST_F(SoakFailedDevelop, All) {
    const gpu::test::Points points = gpu::test::try_each_call([&](Attempt& attempt) { return sequence(attempt); });
    fmt::print("a sequence: {} calls that may fail, {} points tried\n", points.calls, points.tried);
}

}  // namespace
}  // namespace darkroom
