// SPDX-License-Identifier: MIT
// Pictures through the confined process, against the same decoders in this one; and what becomes of a picture whose
// process is lost.
#include "image/confined/confined_source.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <thread>

#include "confined/shared_memory.hpp"
#include "core/files.hpp"
#include "core/test_support_small.hpp"
#include "formats/exr/exr_source.hpp"
#include "image/codec/codecs.hpp"
#include "image/confined/decoder_pool.hpp"
#include "image/frame/frame_file.hpp"
#include "image/picture/picture_source.hpp"
#include "image/picture/write.hpp"
#include "image/test_bytes.hpp"
#include "image/test_files.hpp"

namespace darkroom {
namespace {

using Source = Result<std::unique_ptr<PictureSource>>;

Source open_here(const FileFormat& format, std::span<const std::byte> bytes) {
    if (format.name != "PNG" && format.name != "JPEG" && format.name != "TIFF") return format.open(bytes, 1);
    DARKROOM_TRY_VALUE(const auto library, codecs());
    return library->open(format, bytes);
}

/// All samples of a part, as floats or as they are, in bands of so many rows.
Result<std::vector<std::byte>> samples_of(PictureSource& source, std::size_t number, std::uint32_t band,
                                          bool is_float) {
    const FilePart& part = source.parts()[number];
    const SampleKind kind = is_float || part.kinds[0] == SampleKind::Integer32 ? SampleKind::Float : part.kinds[0];
    const std::size_t pixel = size_of(kind) * part.channels.size(), row = pixel * part.width;
    std::vector<std::byte> out(row * part.height);
    for (std::uint32_t first = 0; first < part.height; first += band) {
        std::vector<SamplePlace> places;
        for (std::size_t c = 0; c < part.channels.size(); ++c)
            places.push_back({.channel = c,
                              .kind = kind,
                              .first = out.data() + first * row + c * size_of(kind),
                              .pixel_bytes = static_cast<std::ptrdiff_t>(pixel),
                              .row_bytes = static_cast<std::ptrdiff_t>(row)});
        DARKROOM_TRY(source.read_rows(number, first, std::min(band, part.height - first), places));
    }
    return out;
}

std::vector<std::byte> told(const Result<std::vector<std::byte>>& samples) {
    EXPECT_TRUE(samples) << samples.error().text;
    return samples.value_or(std::vector<std::byte>());
}

void expect_same(const std::filesystem::path& path) {
    const auto bytes = read_file(path);
    ASSERT_TRUE(bytes) << path;
    const auto format = format_of_file(*bytes);
    ASSERT_TRUE(format) << path;
    const Source here = open_here(**format, *bytes);
    const auto there = open_source(*bytes);
    ASSERT_TRUE(here) << path << here.error().text;
    ASSERT_TRUE(there) << path << there.error().text;
    EXPECT_EQ(there->format, *format);
    EXPECT_EQ(dynamic_cast<const ExrSource*>(there->source.get()), nullptr);
    ASSERT_EQ((*here)->parts().size(), there->source->parts().size());
    for (std::size_t i = 0; i < (*here)->parts().size(); ++i) {
        const FilePart &a = (*here)->parts()[i], &b = there->source->parts()[i];
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.view, b.view);
        EXPECT_EQ(a.views, b.views);
        EXPECT_EQ(a.compression, b.compression);
        EXPECT_EQ(a.color_space, b.color_space);
        EXPECT_EQ(a.has_primaries, b.has_primaries);
        EXPECT_EQ(a.channels, b.channels);
        EXPECT_EQ(a.kinds, b.kinds);
        EXPECT_EQ(std::tie(a.x, a.y, a.width, a.height), std::tie(b.x, b.y, b.width, b.height));
        EXPECT_EQ(std::tie(a.display_width, a.display_height), std::tie(b.display_width, b.display_height));
        EXPECT_EQ((*here)->row_unit(i), there->source->row_unit(i));
        for (const std::string& name : there->source->attributes(i))
            EXPECT_EQ((*here)->numbers(i, name), there->source->numbers(i, name)) << path << name;
        for (const bool is_float : {false, true}) {
            // Anew: OpenImageIO goes back in no file that it has by no name.
            const auto expected = samples_of(**open_here(**format, *bytes), i, a.height, is_float);
            ASSERT_TRUE(expected) << path << expected.error().text;
            EXPECT_EQ(*expected, told(samples_of(*there->source, i, a.height, is_float))) << path;
            EXPECT_EQ(*expected, told(samples_of(*there->source, i, 100, is_float))) << path;
        }
    }
}

/// Processes that decode for this one. What was killed is gone when the last of its threads is.
std::vector<pid_t> decoders() {
    std::vector<pid_t> out;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
        std::ifstream stream(entry.path() / "status");
        const std::string status{std::istreambuf_iterator<char>(stream), {}};
        if (status.starts_with("Name:\tdarkroom_decode\n") &&
            status.find("\nPPid:\t" + std::to_string(::getpid()) + "\n") != std::string::npos &&
            (status.find("\nState:\tZ") == std::string::npos || status.find("\nThreads:\t1\n") == std::string::npos))
            out.push_back(std::stoi(entry.path().filename()));
    }
    return out;
}

class ImageConfined : public WithFolder {
  protected:
    std::filesystem::path picture(const std::string& name, std::uint32_t width = 70, std::uint32_t height = 50) const {
        Picture pixels(width, height);
        std::mt19937 random(width);
        std::uniform_real_distribution<float> any(0, 1);
        for (float& value : pixels.pixels) value = any(random);
        EXPECT_TRUE(write_picture(file(name), pixels, {}));
        return file(name);
    }
};

TEST_F(ImageConfined, SamplesAreThoseOfThisProcess) {
    for (const SampleKind kind : {SampleKind::Integer8, SampleKind::Integer16, SampleKind::Half, SampleKind::Float})
        for (const char* const name : {"a.png", "a.tif", "a.jpg", "a.hdr", "a.exr"}) {
            Picture pixels(300, 211);
            std::mt19937 random(3);
            std::uniform_real_distribution<float> any(0, 1);
            for (float& value : pixels.pixels) value = any(random);
            if (write_picture(file(name), pixels, {.samples = kind})) expect_same(file(name));
        }
    // Rows that are more than is handed over at a time.
    expect_same(picture("large.png", 3000, 2000));
}

// Of TIFF a process without OpenImageIO hands on what it does not read.
TEST_F(ImageConfined, RareTiffIsReadByOpenImageIo) {
    TestTiff tiff = TestTiff::gray(16, 9);
    tiff.tags[258] = {4}, tiff.tags[279] = {8 * 9};
    put(file("a.tif"), tiff.text());
    expect_same(file("a.tif"));
}

class ImageConfinedData : public WithData {};

TEST_F(ImageConfinedData, EveryPictureIsTheSame) {
    std::size_t count = 0;
    const std::uintmax_t max_bytes = test::is_small() ? 1'000'000 : 8'000'000;
    for (const char* const folder : {"composite", "env", "exr", "flip", "hud", "lut", "models", "noise"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(data_ / folder)) {
            if (!entry.is_regular_file() || entry.file_size() > max_bytes) continue;
            const auto bytes = read_file(entry.path());
            if (!bytes || !format_of_file(*bytes) || !open_source(*bytes)) continue;
            expect_same(entry.path());
            ++count;
        }
    EXPECT_GT(count, 10u);
}

TEST_F(ImageConfined, TheProcessIsConfined) {
    ASSERT_TRUE(read_frame(picture("a.png")));
    const std::vector<pid_t> found = decoders();
    ASSERT_FALSE(found.empty());
    for (const pid_t one : found) {
        const std::string status = content("/proc/" + std::to_string(one) + "/status");
        EXPECT_NE(status.find("\nNoNewPrivs:\t1\n"), std::string::npos) << status;
        EXPECT_NE(status.find("\nSeccomp:\t2\n"), std::string::npos) << status;
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
        const std::string limits = content("/proc/" + std::to_string(one) + "/limits");
        EXPECT_EQ(limits.find("Max address space         unlimited"), std::string::npos) << limits;
#endif
    }
}

TEST_F(ImageConfined, OneProcessServesManyPictures) {
    ASSERT_TRUE(read_frame(picture("a.png")));
    const std::vector<pid_t> before = decoders();
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(read_frame(picture("b.png", 60 + i)));
    EXPECT_EQ(decoders(), before);
}

// A process is stopped while it decodes, and ended.
TEST_F(ImageConfined, APictureWhoseProcessEndsIsAnErrorAndTheNextIsRead) {
    const auto path = picture("a.png");
    const auto expected = read_frame(path);
    ASSERT_TRUE(expected);
    for (const pid_t one : decoders()) ::kill(one, SIGSTOP);
    std::string error;
    std::thread reading([&] {
        const auto frame = read_frame(path);
        if (!frame) error = frame.error().text;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    for (const pid_t one : decoders()) ::kill(one, SIGKILL);
    reading.join();
    EXPECT_EQ(error, path.string() + ": cannot be decoded: its decoder was ended by signal 9 (Killed)");
    const auto again = read_frame(path);
    ASSERT_TRUE(again) << again.error().text;
    EXPECT_EQ(again->color.pixels, expected->color.pixels);
}

// A picture that is open when its process is lost to another is opened again.
TEST_F(ImageConfined, APictureOutlivesTheProcessThatOpenedIt) {
    const auto bytes = read_file(picture("a.png"));
    auto opened = open_source(*bytes);
    ASSERT_TRUE(opened);
    const auto before = samples_of(*opened->source, 0, 50, true);
    ASSERT_TRUE(before);
    for (const pid_t one : decoders()) ::kill(one, SIGKILL);
    static_cast<void>(samples_of(*opened->source, 0, 50, true));
    const auto after = samples_of(*opened->source, 0, 50, true);
    ASSERT_TRUE(after) << after.error().text;
    EXPECT_EQ(*before, *after);
}

TEST_F(ImageConfined, ADecoderThatHangsIsGivenUp) {
    const auto path = picture("a.png");
    ASSERT_TRUE(read_frame(path));
    const std::uint32_t usual = std::exchange(DecoderPool::shared().seconds, 1);
    for (const pid_t one : decoders()) ::kill(one, SIGSTOP);
    const auto frame = read_frame(path);
    DecoderPool::shared().seconds = usual;
    ASSERT_FALSE(frame);
    EXPECT_EQ(frame.error().text, path.string() + ": cannot be decoded: its decoder took more than 2 s");
    EXPECT_EQ(frame.error().fault, Fault::User);
    EXPECT_TRUE(read_frame(path));
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(ImageConfined, ADecoderThatTakesTooMuchMemoryIsAnError) {
    auto& pool = DecoderPool::shared();
    for (const char* const name : {"a.png", "a.jpg", "a.tif", "a.exr"}) {
        const auto bytes = read_file(picture(name, 3000, 1000));
        const std::uint64_t usual = std::exchange(pool.memory_at_rest, 0);
        const std::uint64_t usual_of_a_byte = std::exchange(pool.memory_of_a_byte, 0);
        const auto opened = open_source(*bytes, 1);
        std::string error = opened ? "" : opened.error().text;
        if (opened)
            if (const auto samples = samples_of(*opened->source, 0, 1000, true); !samples) error = samples.error().text;
        pool.memory_at_rest = usual;
        pool.memory_of_a_byte = usual_of_a_byte;
        EXPECT_FALSE(error.empty()) << name;
        EXPECT_EQ(std::ranges::count(error, '\n'), 0) << error;
        EXPECT_TRUE(open_source(*bytes, 1)) << name;
    }
}
#endif

TEST_F(ImageConfined, ThereAreAsManyProcessesAsProcessors) {
    const std::string path = picture("a.png", 600, 400).string();
    std::vector<std::thread> readers;
    for (unsigned i = 0; i < 4 * std::thread::hardware_concurrency() + 4; ++i)
        readers.emplace_back([&] {
            for (int times = 0; times < 3; ++times) EXPECT_TRUE(read_frame(path));
        });
    for (std::thread& one : readers) one.join();
    // With OpenImageIO as many, which other pictures needed.
    EXPECT_LE(decoders().size(), 2 * std::max(1U, std::thread::hardware_concurrency()));
}

TEST_F(ImageConfined, AProcessThatEndedBetweenPicturesIsNoError) {
    const auto path = picture("a.png");
    ASSERT_TRUE(read_frame(path));
    for (const pid_t one : decoders()) ::kill(one, SIGKILL);
    for (int tries = 0; tries < 1000 && !decoders().empty(); ++tries)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const auto frame = read_frame(path);
    EXPECT_TRUE(frame) << frame.error().text;
}

TEST_F(ImageConfined, MemoryThatIsSharedKeepsItsSize) {
    const auto bytes = read_file(picture("a.png"));
    auto opened = open_source(*bytes);
    ASSERT_TRUE(opened && samples_of(*opened->source, 0, 50, true));
    std::size_t found = 0;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
        std::error_code ignored;
        if (!std::filesystem::read_symlink(entry.path(), ignored).string().starts_with("/memfd:darkroom")) continue;
        ++found;
        const int file = std::stoi(entry.path().filename());
        EXPECT_EQ(::fcntl(file, F_GET_SEALS) & (F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL),
                  F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL);
        EXPECT_NE(::ftruncate(file, 1), 0);
        EXPECT_NE(::ftruncate(file, 1 << 30), 0);
    }
    EXPECT_GE(found, 1u);
    const auto held = SharedMemory::holding(*bytes);
    ASSERT_TRUE(held);
    EXPECT_NE(::write(held->descriptor(), "a", 1), 1) << "what a decoder reads is written by nobody";
    EXPECT_TRUE(Mapping(held->descriptor(), held->size(), true).bytes().empty());
    const Mapping mapped(held->descriptor(), held->size(), false);
    EXPECT_TRUE(std::ranges::equal(mapped.bytes(), *bytes));
}

TEST_F(ImageConfined, DecodingCanBeSwitchedOff) {
    const auto exr = picture("a.exr"), png = picture("a.png");
    allow_decoding(false);
    for (const auto& path : {exr, png}) {
        const auto frame = read_frame(path);
        ASSERT_FALSE(frame);
        EXPECT_EQ(frame.error().text, path.string() + ": decoding of pictures is switched off in this process");
    }
    allow_decoding(true);
    for (const auto& path : {exr, png}) EXPECT_TRUE(read_frame(path));
}

// What OpenEXR itself would unpack is unpacked elsewhere, in frames, too.
TEST_F(ImageConfined, OfFramesOnlyWhatWeUnpackIsReadHere) {
    for (const char* const compression : {"none", "zips", "zip", "rle", "piz", "pxr24", "b44", "dwaa"}) {
        Picture pixels(40, 40);
        for (std::size_t i = 0; i < pixels.pixels.size(); ++i) pixels.pixels[i] = static_cast<float>(i % 7) / 8;
        ASSERT_TRUE(write_picture(file("a.exr"), pixels, {.compression = compression})) << compression;
        const auto bytes = read_file(file("a.exr"));
        for (const pid_t one : decoders()) ::kill(one, SIGKILL);
        for (int tries = 0; tries < 100 && !decoders().empty(); ++tries)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        auto frame = open_source(*bytes, 1, DecodingPlace::FramesHere);
        ASSERT_TRUE(frame) << compression;
        EXPECT_TRUE(decoders().empty()) << compression;
        const auto samples = samples_of(*frame->source, 0, 40, true);
        const bool is_ours =
            std::string_view(compression) == "none" || std::string_view(compression).starts_with("zip");
        EXPECT_EQ(samples.has_value(), true) << compression;
        EXPECT_EQ(decoders().empty(), is_ours) << compression;
        const Source here = ExrSource::open(*bytes, 1);
        EXPECT_EQ(told(samples), told(samples_of(**here, 0, 40, true))) << compression;
    }
}

TEST(ImageConfinedWords, ADescriptionThatNoFileHasIsRefused) {
    PictureDescription description;
    description.parts.push_back({{.channels = {"R", "G"},
                                  .kinds = {SampleKind::Half, SampleKind::Float},
                                  .width = 3,
                                  .height = 2,
                                  .display_width = 3,
                                  .display_height = 2},
                                 16,
                                 {{"fov", {1, 2}}}});
    const std::vector<std::byte> bytes = packed(description);
    const auto same = unpacked(bytes);
    ASSERT_TRUE(same);
    EXPECT_EQ(packed(*same), bytes);
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_FALSE(unpacked(std::span(bytes).first(size))) << size;
    std::mt19937 random(1);
    for (int round = 0; round < 20000; ++round) {
        std::vector<std::byte> damaged = bytes;
        for (int i = 0; i < 1 + round % 4; ++i) damaged[random() % damaged.size()] = static_cast<std::byte>(random());
        const auto other = unpacked(damaged);
        if (!other) continue;
        for (const auto& part : other->parts) {
            EXPECT_EQ(part.part.kinds.size(), part.part.channels.size());
            EXPECT_GE(part.row_unit, 1u);
            EXPECT_GE(part.part.width, 1u);
        }
    }
    description.parts[0].part.kinds[0] = static_cast<SampleKind>(9);
    EXPECT_FALSE(unpacked(packed(description)));
    description.parts[0].part.kinds[0] = SampleKind::Half;
    description.parts[0].row_unit = 0;
    EXPECT_FALSE(unpacked(packed(description)));
}

}  // namespace
}  // namespace darkroom
