// SPDX-License-Identifier: MIT
#include "formats/exr/exr_zip.hpp"

#include <Imath/half.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfHeader.h>
#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

#include "core/thread/parallel.hpp"

namespace darkroom {
namespace {

static_assert(std::endian::native == std::endian::little, "files are little-endian, and read in place");

#ifdef _MSC_VER
// No vector extensions there: every byte is left to undo_differences().
std::size_t undo_blocks(std::uint8_t*, std::size_t, std::uint8_t&) { return 0; }
#else
using Block = std::uint8_t __attribute__((vector_size(16)));

/// Sums sixteen at a time; `last` is the byte before. Returns how many bytes are done.
std::size_t undo_blocks(std::uint8_t* bytes, std::size_t count, std::uint8_t& last) {
    const Block zero{}, middle = zero + 128;
    Block before = zero + last;
    std::size_t i = 0;
    for (; i + sizeof(Block) <= count; i += sizeof(Block)) {
        Block sums;
        std::memcpy(&sums, bytes + i, sizeof sums);
        sums -= middle;
        sums += __builtin_shufflevector(zero, sums, 0, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30);
        sums += __builtin_shufflevector(zero, sums, 0, 0, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29);
        sums += __builtin_shufflevector(zero, sums, 0, 0, 0, 0, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27);
        sums += __builtin_shufflevector(zero, sums, 0, 0, 0, 0, 0, 0, 0, 0, 16, 17, 18, 19, 20, 21, 22, 23);
        sums += before;
        std::memcpy(bytes + i, &sums, sizeof sums);
        last = bytes[i + sizeof(Block) - 1];
        before = zero + last;
    }
    return i;
}
#endif

/// Each byte is the difference to the one before, plus 128.
void undo_differences(std::uint8_t* bytes, std::size_t count) {
    std::uint8_t last = 128;
    for (std::size_t i = undo_blocks(bytes, count, last); i < count; ++i)
        bytes[i] = last = static_cast<std::uint8_t>(last + bytes[i] - 128);
}

// Bytes of even places come first, then those of odd ones.
void interleave(const std::uint8_t* bytes, std::size_t count, std::uint8_t* out) {
    const std::uint8_t* const odd = bytes + (count + 1) / 2;
    for (std::size_t i = 0; i < count / 2; ++i) {
        out[2 * i] = bytes[i];
        out[2 * i + 1] = odd[i];
    }
    if (count % 2 == 1) out[count - 1] = bytes[count / 2];
}

template <class From, class To, class Convert>
void place_row(const std::uint8_t* from, std::size_t width, std::byte* to, std::ptrdiff_t pixel_bytes,
               const Convert& convert) {
    for (std::size_t x = 0; x < width; ++x, from += sizeof(From), to += pixel_bytes) {
        From value;
        std::memcpy(&value, from, sizeof value);
        const To converted = convert(value);
        std::memcpy(to, &converted, sizeof converted);
    }
}

void place_row(const std::uint8_t* from, SampleKind kind, std::size_t width, std::byte* to, const SamplePlace& place) {
    const auto same = [](auto value) { return value; };
    const bool is_half = place.kind == SampleKind::Half;
    if (kind == SampleKind::Half && is_half)
        place_row<std::uint16_t, std::uint16_t>(from, width, to, place.pixel_bytes, same);
    else if (kind == SampleKind::Half)
        place_row<std::uint16_t, float>(from, width, to, place.pixel_bytes, imath_half_to_float);
    else if (kind == SampleKind::Float && is_half)
        place_row<float, std::uint16_t>(from, width, to, place.pixel_bytes, imath_float_to_half);
    else if (kind == SampleKind::Float)
        place_row<float, float>(from, width, to, place.pixel_bytes, same);
    else if (place.kind == SampleKind::Integer32)
        place_row<std::uint32_t, std::uint32_t>(from, width, to, place.pixel_bytes, same);
    else
        place_row<std::uint32_t, float>(from, width, to, place.pixel_bytes,
                                        [](std::uint32_t value) { return static_cast<float>(value); });
}

struct FreeDecompressor {
    void operator()(libdeflate_decompressor* decompressor) const { libdeflate_free_decompressor(decompressor); }
};

/// The packed chunks of a part. OpenEXR reads one at a time: all share the place in the file.
class Chunks {
  public:
    Chunks(const Imf::InputPart& part, std::size_t chunk_bytes) : part_(part), chunk_bytes_(chunk_bytes) {}

    /// The chunk that begins with this scan line. It is never larger than a whole one unpacked.
    void read(int line, std::vector<char>& packed) {
        const std::lock_guard lock(mutex_);
        packed.resize(chunk_bytes_);
        int size = static_cast<int>(chunk_bytes_);
        part_.rawPixelDataToBuffer(line, packed.data(), size);
        packed.resize(static_cast<std::size_t>(size));
    }

  private:
    const Imf::InputPart& part_;
    std::size_t chunk_bytes_;
    std::mutex mutex_;
};

/// What one thread needs.
class Worker {
  public:
    explicit Worker(Chunks& chunks) : chunks_(chunks) {
        if (!inflate_) throw std::bad_alloc();
    }

    /// The `size` bytes of the chunk that begins with this scan line, or nothing where it is damaged.
    [[nodiscard]] std::span<const std::uint8_t> unpack(int line, std::size_t size) {
        chunks_.read(line, packed_);
        if (packed_.size() == size)  // what does not become smaller is stored as it is
            return {reinterpret_cast<const std::uint8_t*>(packed_.data()), size};
        inflated_.resize(size);
        bytes_.resize(size);
        if (libdeflate_zlib_decompress(inflate_.get(), packed_.data(), packed_.size(), inflated_.data(), size,
                                       nullptr) != LIBDEFLATE_SUCCESS)
            return {};
        undo_differences(inflated_.data(), size);
        interleave(inflated_.data(), size, bytes_.data());
        return bytes_;
    }

  private:
    Chunks& chunks_;
    std::unique_ptr<libdeflate_decompressor, FreeDecompressor> inflate_{libdeflate_alloc_decompressor()};
    std::vector<char> packed_;
    std::vector<std::uint8_t> inflated_, bytes_;
};

}  // namespace

Result<> read_zip_rows(const Imf::InputPart& part, std::span<const ZipChannel> channels, std::uint32_t row,
                       std::uint32_t rows, std::size_t max_threads) {
    const Imath::Box2i& window = part.header().dataWindow();
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    const auto height = static_cast<std::uint32_t>(window.max.y - window.min.y + 1);
    const std::uint32_t lines = part.header().compression() == Imf::ZIP_COMPRESSION ? 16 : 1;
    std::size_t row_bytes = 0;
    for (const ZipChannel& channel : channels) row_bytes += width * size_of(channel.kind);
    const std::uint32_t first = row / lines, end = (row + rows + lines - 1) / lines;
    std::atomic<std::uint32_t> next{first}, damaged{end};
    Chunks chunks(part, lines * row_bytes);
    const auto read_chunks = [&] {
        Worker worker(chunks);
        for (std::uint32_t chunk = next++; chunk < end; chunk = next++) {
            const std::uint32_t top = chunk * lines, bottom = std::min(top + lines, height);
            const std::span<const std::uint8_t> bytes =
                worker.unpack(window.min.y + static_cast<int>(top), (bottom - top) * row_bytes);
            if (bytes.empty()) {
                damaged = chunk;
                return;
            }
            for (std::uint32_t y = std::max(top, row); y < std::min(bottom, row + rows); ++y) {
                const std::uint8_t* from = bytes.data() + (y - top) * row_bytes;
                for (const ZipChannel& channel : channels) {
                    if (channel.place != nullptr)
                        place_row(
                            from, channel.kind, width,
                            channel.place->first + static_cast<std::ptrdiff_t>(y - row) * channel.place->row_bytes,
                            *channel.place);
                    from += width * size_of(channel.kind);
                }
            }
        }
    };
    const std::size_t threads = max_threads > 0 ? max_threads : std::max(1U, std::thread::hardware_concurrency());
    parallel_for(std::min<std::size_t>(threads, end - first), threads, [&](std::size_t) { read_chunks(); });
    if (damaged != end)
        return user_error(fmt::format("damaged or truncated: chunk {} cannot be unpacked", damaged + 1));
    return {};
}

}  // namespace darkroom
