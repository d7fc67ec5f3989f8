// SPDX-License-Identifier: MIT
// Every allocation fails once, on a device whose driver is spared: nothing is left behind, no object of Vulkan and no
// file, and the same call then does what it should.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>

#include "compose/test_stacks/host.hpp"
#include "core/caught.hpp"
#include "core/files.hpp"
#include "core/test_support_allocations.hpp"
#include "gpu/resource/resources.hpp"
#include "gpu/test_failing/attempts.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/write.hpp"

namespace darkroom {
namespace {

using gpu::test::Attempt;
using test::add;
using test::FailingAllocation;
using test::Host;

/// Which of `count` allocations fail.
std::vector<std::uint64_t> chosen(std::uint64_t count, std::size_t most) {
    std::vector<std::uint64_t> numbers(count);
    for (std::uint64_t i = 0; i < count; ++i) numbers[i] = i;
    std::mt19937 random(3);
    if (numbers.size() > most) std::ranges::shuffle(numbers, random);
    numbers.resize(std::min(numbers.size(), most));
    return numbers;
}

void expect_lack(const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::OutOfMemory) << error.text;
    EXPECT_EQ(error.fault, Fault::Machine) << error.text;
    EXPECT_NE(error.text.find("out of memory"), std::string::npos) << error.text;
}

class Allocations : public test::StackTest {
  protected:
    void SetUp() override {
        if (!test::counts_allocations()) GTEST_SKIP() << "this build has its own operator new";
        StackTest::SetUp();
    }
    static void fill_stack(Composer& composer) {
        add(composer, "bloom");
        const Handle blur = add(composer, "gaussian_blur");
        add(composer, "blend", {}, {.second = blur.previous(), .opacity = 0.5f});
        add(composer, "encode");
        add(composer, "dither");
    }

    /// `call` with one allocation failing, then without: `again` sees that all is well. Tells how many were tried.
    template <class Call, class Again>
    static std::size_t try_each(std::uint64_t count, std::size_t most, const Call& call, const Again& again) {
        std::size_t tried = 0;
        for (const std::uint64_t number : chosen(count, most)) {
            SCOPED_TRACE(fmt::format("allocation {} of {}", number, count));
            Result<> done;
            {
                const FailingAllocation failing(number);
                done = call();
            }
            if (!done) expect_lack(done.error());
            again();
            ++tried;
            if (HasFailure()) break;
        }
        return tried;
    }

    void adopt(std::size_t most) const {
        Attempt attempt;
        const std::uint64_t before = test::allocation_count();
        static_cast<void>(test::must(attempt.adopted(host.device)));
        const std::uint64_t count = test::allocation_count() - before;
        const AdoptDesc desc = attempt.desc_over(host.device);
        const auto call = [&]() -> Result<> {
            const auto made = Device::adopt(desc);
            return made ? Result<>{} : failure(made.error());
        };
        const auto again = [&] {
            EXPECT_EQ(gpu::test::failing::alive(), std::vector<std::string>{});
            EXPECT_TRUE(attempt.adopted(host.device));
        };
        fmt::print("adopting: {} allocations, {} failed\n", count, try_each(count, most, call, again));
    }

    /// Memory that is mapped has more words to say than other.
    void make_buffers() const {
        Attempt attempt;
        const Device device = test::must(attempt.adopted(host.device));
        const std::size_t alive = gpu::test::failing::alive().size();
        for (const gpu::MemoryKind kind :
             {gpu::MemoryKind::Device, gpu::MemoryKind::Upload, gpu::MemoryKind::Readback}) {
            const auto call = [&]() -> Result<> {
                try {
                    const auto made = gpu::Buffer::create(device.context(), 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                                          kind, "with a name that no string holds in place");
                    return made ? Result<>{} : failure(made.error());
                } catch (const std::bad_alloc&) {
                    return caught("making a buffer");
                }
            };
            const std::uint64_t before = test::allocation_count();
            test::must(call());
            const std::uint64_t count = test::allocation_count() - before;
            EXPECT_GT(count, 3U);
            const auto again = [&] {
                test::must(call());
                EXPECT_EQ(gpu::test::failing::alive().size(), alive) << "objects are left";
            };
            fmt::print("a buffer: {} allocations, {} failed\n", count, try_each(count, count, call, again));
        }
    }

    /// Planned and compiled, the kernels of it made, too, where each try has a device of its own.
    void compile(bool has_own_device, std::size_t most) const {
        Attempt attempt;
        std::optional<Device> device(test::must(attempt.adopted(host.device)));
        const auto fresh = [&] {
            Composer composer(*device, {.has_timers = true, .max_threads = 0});
            fill_stack(composer);
            return composer;
        };
        std::optional<Composer> composer(fresh());
        test::must(composer->compile(host.compile_desc()));
        const ReferenceImage expected = host.run(*composer);
        const auto renew = [&] {
            composer.reset();
            if (has_own_device) device.reset();
            if (has_own_device) device.emplace(test::must(attempt.adopted(host.device)));
            composer.emplace(fresh());
        };
        renew();
        const std::size_t alive = gpu::test::failing::alive().size();
        const std::uint64_t before = test::allocation_count();
        test::must(composer->compile(host.compile_desc()));
        const std::uint64_t count = test::allocation_count() - before;
        renew();
        const auto call = [&]() -> Result<> {
            const auto made = composer->compile(host.compile_desc());
            return made ? Result<>{} : failure(made.error());
        };
        const auto again = [&] {
            test::must(composer->compile(host.compile_desc()));
            EXPECT_EQ(test::worst_difference(host.run(*composer), expected), 0);
            renew();
            EXPECT_EQ(gpu::test::failing::alive().size(), alive) << "objects are left";
        };
        fmt::print("compiling{}: {} allocations, {} failed\n", has_own_device ? ", kernels, too" : "", count,
                   try_each(count, most, call, again));
    }

    /// An edit, which failed, leaves the picture that there was.
    void edit(std::size_t most) const {
        Attempt attempt;
        Device device = test::must(attempt.adopted(host.device)), other = test::must(attempt.adopted(host.device));
        Composer composer(device, {.max_threads = 0});
        fill_stack(composer);
        CompileDesc small = host.compile_desc(), large = small;
        large.max_extent = {77, 50};
        test::must(composer.compile(small));
        static_cast<void>(host.run(composer));
        const ReferenceImage expected = host.run(composer);
        const auto counted = [&](const auto& call) {
            const std::uint64_t before = test::allocation_count();
            test::must(call());
            return test::allocation_count() - before;
        };
        const auto no_plan = [](Result<Plan> made) { return made ? Result<>{} : Result<>(failure(made.error())); };
        const auto later = [&]() -> Result<> {
            DARKROOM_TRY(composer.compile_later(large));
            const PendingCompile pending = composer.pending();
            return pending.error ? failure(*pending.error) : Result<>{};
        };
        const auto rebind = [&] { return no_plan(composer.rebind(other)); };
        const auto same = [&] {
            test::must(composer.compile(small));
            static_cast<void>(host.run(composer));
            EXPECT_EQ(test::worst_difference(host.run(composer), expected), 0);
        };
        const std::uint64_t later_count = counted(later);
        fmt::print("compiling beside: {} allocations, {} failed\n", later_count,
                   try_each(later_count, most, later, same));
        counted(rebind);
        test::must(composer.rebind(device));
        const std::uint64_t rebind_count = counted(rebind);
        const auto back = [&] {
            static_cast<void>(host.run(composer));
            EXPECT_EQ(test::worst_difference(host.run(composer), expected), 0);
            test::must(composer.rebind(device));
        };
        fmt::print("binding: {} allocations, {} failed\n", rebind_count, try_each(rebind_count, most, rebind, back));
    }

    const ReferenceImage picture = test::round_to_float(test::random_display(40, 24, 7));
    const Host host{picture};
};

class GpuFailedAllocations : public Allocations {};
class SoakFailedAllocations : public Allocations {};

constexpr std::size_t few = 60, all = ~std::size_t{0};
TEST_F(GpuFailedAllocations, OfAnAdoptedDevice) { adopt(few); }
TEST_F(GpuFailedAllocations, OfBuffers) { make_buffers(); }
TEST_F(GpuFailedAllocations, OfACompile) { compile(false, few); }
TEST_F(GpuFailedAllocations, OfKernels) { compile(true, 6); }
TEST_F(GpuFailedAllocations, OfEdits) { edit(few / 4); }
TEST_F(SoakFailedAllocations, OfAnAdoptedDevice) { adopt(all); }
TEST_F(SoakFailedAllocations, OfACompile) { compile(false, 20'000); }
TEST_F(SoakFailedAllocations, OfKernels) { compile(true, 600); }
TEST_F(SoakFailedAllocations, OfEdits) { edit(2'000); }

/// Files that are written: what was there stays whole, or what comes is.
TEST(FailedAllocations, OfWhatWritesFiles) {
    if (!test::counts_allocations()) GTEST_SKIP() << "this build has its own operator new";
    namespace fs = std::filesystem;
    const fs::path folder = fs::temp_directory_path() / "darkroom_failed_allocations";
    fs::remove_all(folder);
    fs::create_directories(folder);
    Picture picture(9, 7);
    FrameFile frame;
    frame.color = picture;
    frame.depth = Plane<1>(9, 7);
    const std::string text = "a text\n";
    struct Writer {
        std::string name;
        std::function<Result<>(const fs::path&)> write;
    };
    const std::vector<Writer> writers{
        {"a.txt", [&](const fs::path& to) { return write_file(to, std::as_bytes(std::span(text)), true); }},
        {"a.png", [&](const fs::path& to) { return write_picture(to, picture, {}); }},
        {"a.exr", [&](const fs::path& to) { return write_frame(to, frame); }}};
    const auto content_of = [](const fs::path& path) { return gpu::test::must(read_file(path)); };
    std::size_t tried = 0;
    for (const Writer& writer : writers) {
        const fs::path to = folder / writer.name;
        gpu::test::must(writer.write(to));
        const std::vector<std::byte> whole = content_of(to);
        for (std::uint64_t number = 0;; ++number) {
            SCOPED_TRACE(fmt::format("{}, allocation {}", writer.name, number));
            std::ofstream(to) << "old";
            const std::vector<std::byte> old = content_of(to);
            bool is_done = false, has_failed = false;
            {
                const FailingAllocation failing(number);
                try {
                    is_done = writer.write(to).has_value();
                } catch (const std::bad_alloc&) {
                    is_done = false;
                }
                has_failed = failing.has_failed();
            }
            EXPECT_EQ(content_of(to), is_done ? whole : old);
            EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1) << "a file is left";
            ++tried;
            if (HasFailure() || !has_failed) break;
        }
        fs::remove(to);
    }
    fmt::print("{} allocations of writers failed\n", tried);
    fs::remove_all(folder);
}

}  // namespace
}  // namespace darkroom
