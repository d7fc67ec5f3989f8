// SPDX-License-Identifier: MIT
#include "formats/tiff/tiff_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

#include "formats/exr/exr_check.hpp"
#include "formats/jpeg/jpeg_check.hpp"

namespace darkroom {
namespace {

// TIFF 6.0 (Adobe, 1992), section 8 and the extensions after it; BigTIFF as libtiff has it.
enum Tag : std::uint32_t {
    new_subfile_type = 254,
    subfile_type = 255,
    image_width = 256,
    image_length = 257,
    bits_per_sample = 258,
    compression_tag = 259,
    photometric = 262,
    strip_offsets = 273,
    samples_per_pixel = 277,
    rows_per_strip = 278,
    strip_byte_counts = 279,
    planar_configuration = 284,
    color_map = 320,
    tile_width = 322,
    tile_length = 323,
    tile_offsets = 324,
    tile_byte_counts = 325,
    sub_directories = 330,
    sample_format = 339,
    ycbcr_subsampling = 530,
    image_depth = 32997,
    icc_profile = 34675,
};

// What says how samples lie and what they mean; the rest (texts, profiles, other pictures) no decoder shall see. In the
// gaps: fill order, orientation, resolution and its unit, fax options, predictor, inks, extra samples, format of
// samples, tables of JPEG, conversion of YCbCr.
constexpr std::array<std::uint32_t, 31> kept_tags{256, 257, 258, 259, 262, 266, 273, 274, 277, 278, 279,
                                                  282, 283, 284, 292, 293, 296, 317, 320, 322, 323, 324,
                                                  325, 332, 338, 339, 347, 529, 530, 531, 532};

constexpr std::uint64_t max_tile_side = 8192;
// A tile may be as large as the picture, between these.
constexpr std::uint64_t always_tile_bytes = std::uint64_t{1} << 24;
constexpr std::uint64_t max_tile_bytes = std::uint64_t{1} << 28;
constexpr std::uint64_t max_tags = 4096;
// Of all pages together: those behind them are not looked for.
constexpr std::uint64_t max_tags_of_pages = std::uint64_t{1} << 20;
constexpr std::uint64_t max_samples = 1024;
// A decoder reads each strip's bytes, be they those of another, too.
constexpr std::uint64_t max_uses_of_bytes = 4;

constexpr std::uint32_t uncompressed = 1, jpeg_compressed = 7;
constexpr std::array<std::uint32_t, 10> known_compressions{1, 2, 3, 4, 5, 7, 8, 32773, 32946, 50000};

struct Entry {
    std::uint32_t tag = 0, type = 0;
    std::uint64_t count = 0;
    std::size_t values = 0;  // where they lie in the file
    std::size_t at = 0;      // where the entry itself lies
};

std::uint64_t size_of_type(std::uint32_t type) {
    constexpr std::array<std::uint64_t, 19> sizes{0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8, 8};
    return type < sizes.size() ? sizes[type] : 0;
}

class TiffChecker {
  public:
    explicit TiffChecker(std::span<const std::byte> file) : file_(file) {}

    Result<std::vector<std::byte>> run() {
        DARKROOM_TRY(read_directory());
        DARKROOM_TRY(check_picture());
        DARKROOM_TRY(check_chunks());
        return cleaned();
    }

    std::span<const std::byte> profile() { return read_directory() ? profile_ : std::span<const std::byte>(); }

    std::string left_out() {
        if (!read_directory()) return {};
        const auto whole = static_cast<std::size_t>(std::ranges::count(pages_, false, &Page::is_smaller));
        const auto chosen = std::ranges::find(pages_, directory_ - count_bytes(), &Page::place);
        if (whole < 2 || chosen == pages_.end()) return {};
        const auto number = chosen - pages_.begin() + 1;
        return fmt::format("has {}{} pages: {} is read", has_more_pages_ ? "more than " : "", pages_.size(),
                           number == 1 ? "the first" : fmt::format("page {}", number));
    }

  private:
    [[nodiscard]] std::uint64_t number(std::size_t at, std::size_t size) const {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < size; ++i)
            value = value << 8 | std::to_integer<std::uint64_t>(file_[at + (is_little_ ? size - 1 - i : i)]);
        return value;
    }
    [[nodiscard]] bool fits(std::uint64_t at, std::uint64_t size) const {
        return at <= file_.size() && size <= file_.size() - at;
    }
    // Which is written anew for the decoder.
    [[nodiscard]] bool overlaps_directory(std::uint64_t at, std::uint64_t size) const {
        return at < tags_end_ + pointer_bytes() && at + size > directory_ - count_bytes();
    }
    static Result<> cut_off() { return user_error("truncated: unexpected end of file in the directory"); }
    static Result<> malformed(std::string_view what) { return user_error(fmt::format("malformed header: {}", what)); }

    /// A picture of the file.
    struct Page {
        std::uint64_t place = 0;              ///< of its directory
        std::uint64_t width = 0, height = 0;  ///< 0: it does not say
        bool is_smaller = false;              ///< a copy of another in fewer pixels
        bool is_mask = false;                 ///< of another's transparency
        std::vector<std::uint64_t> inner{};   ///< places of pictures that only it names
    };

    [[nodiscard]] Entry entry_at(std::size_t at) const {
        return {.tag = static_cast<std::uint32_t>(number(at, 2)),
                .type = static_cast<std::uint32_t>(number(at + 2, 2)),
                .count = number(at + 4, pointer_bytes()),
                .values = at + 4 + pointer_bytes(),
                .at = at};
    }

    /// As far as it can be read.
    [[nodiscard]] Page page_at(std::uint64_t place, std::uint64_t tags) const {
        Page out{.place = place};
        for (std::uint64_t i = 0; i < tags; ++i) {
            Entry entry = entry_at(place + count_bytes() + i * entry_bytes());
            if (entry.tag == new_subfile_type && is_whole(entry)) {
                const std::uint64_t kind = value(entry, 0);
                out.is_smaller = (kind & 1) != 0;
                out.is_mask = (kind & 4) != 0;
            }
            if (entry.tag == subfile_type && is_whole(entry)) out.is_smaller = out.is_smaller || value(entry, 0) == 2;
            if (entry.tag == image_width && is_whole(entry)) out.width = value(entry, 0);
            if (entry.tag == image_length && is_whole(entry)) out.height = value(entry, 0);
            if (entry.tag != sub_directories) continue;
            const std::uint64_t size = size_of_type(entry.type);
            if ((size != 4 && size != 8) || bytes_of(entry).empty()) continue;
            if (entry.count * size > pointer_bytes()) entry.values = number(entry.values, pointer_bytes());
            constexpr std::uint64_t max_inner = 64;
            for (std::uint64_t k = 0; k < std::min(entry.count, max_inner); ++k) out.inner.push_back(value(entry, k));
        }
        return out;
    }

    /// The number of tags, of a directory that lies in the file.
    [[nodiscard]] std::optional<std::uint64_t> tags_at(std::uint64_t place) const {
        if (!fits(place, count_bytes())) return std::nullopt;
        const std::uint64_t tags = number(place, count_bytes());
        if (tags > max_tags || !fits(place + count_bytes(), tags * entry_bytes() + pointer_bytes()))
            return std::nullopt;
        return tags;
    }

    /// The pages from the first on, and which of them is read.
    [[nodiscard]] std::uint64_t find_pages(std::uint64_t first) {
        std::uint64_t all_tags = 0;
        const auto is_known = [&](std::uint64_t place) {
            return std::ranges::find(pages_, place, &Page::place) != pages_.end();
        };
        constexpr std::size_t max_pages = 4096;
        for (std::uint64_t place = first; place != 0 && !is_known(place);) {
            const std::optional<std::uint64_t> tags = tags_at(place);
            if (!tags) break;
            all_tags += *tags;
            has_more_pages_ = pages_.size() == max_pages || all_tags > max_tags_of_pages;
            if (has_more_pages_) break;
            Page page = page_at(place, *tags);
            // Levels of a texture, each of half the sides of that before it, do not all say so.
            const auto is_half = [](std::uint64_t side, std::uint64_t of) {
                return side == std::max<std::uint64_t>(of / 2, 1);
            };
            if (!pages_.empty() && page.width < pages_.back().width && is_half(page.width, pages_.back().width) &&
                is_half(page.height, pages_.back().height))
                page.is_smaller = true;
            pages_.push_back(std::move(page));
            place = number(place + count_bytes() + *tags * entry_bytes(), pointer_bytes());
        }
        const auto is_whole_picture = [](const Page& page) { return !page.is_smaller && !page.is_mask; };
        if (const auto found = std::ranges::find_if(pages_, is_whole_picture); found != pages_.end())
            return found->place;
        for (const Page& page : pages_)
            for (const std::uint64_t place : page.inner)
                if (const auto tags = tags_at(place); tags && is_whole_picture(page_at(place, *tags))) return place;
        return first;
    }

    Result<> read_directory() {
        if (file_.size() < 8) return cut_off();
        is_little_ = file_[0] == std::byte{'I'};
        is_big_tiff_ = number(2, 2) == 43;
        if (is_big_tiff_ && (file_.size() < 16 || number(4, 2) != 8)) return cut_off();
        const std::uint64_t place = find_pages(number(pointer_bytes() == 8 ? 8 : 4, pointer_bytes()));
        if (!fits(place, count_bytes())) return cut_off();
        const std::uint64_t count = number(place, count_bytes());
        if (count > max_tags) return malformed(fmt::format("{} tags, at most {} are allowed", count, max_tags));
        directory_ = place + count_bytes();
        if (!fits(directory_, count * entry_bytes() + pointer_bytes())) return cut_off();
        tags_end_ = directory_ + count * entry_bytes();
        for (std::size_t at = directory_; at < tags_end_; at += entry_bytes()) {
            Entry entry = entry_at(at);
            if (entry.tag == icc_profile && profile_.empty()) profile_ = bytes_of(entry);
            if (entry.tag == image_depth && is_whole(entry) && entry.count == 1 && value(entry, 0) > 1)
                return user_error(fmt::format("a volume of {} slices, which is not read", value(entry, 0)));
            // A decoder takes the first of several.
            if (std::ranges::find(kept_tags, entry.tag) == kept_tags.end() || find(entry.tag) != nullptr) continue;
            const std::uint64_t size = size_of_type(entry.type);
            if (size == 0) return malformed(fmt::format("tag {} has values of type {}", entry.tag, entry.type));
            if (entry.count == 0 || entry.count > file_.size() / size)
                return malformed(
                    fmt::format("tag {} has {} values in a file of {} bytes", entry.tag, entry.count, file_.size()));
            if (entry.count * size > pointer_bytes()) entry.values = number(entry.values, pointer_bytes());
            if (!fits(entry.values, entry.count * size))
                return user_error(fmt::format("truncated: the values of tag {} lie outside the file of {} bytes",
                                              entry.tag, file_.size()));
            if (overlaps_directory(entry.values, entry.count * size) && entry.values != at + 4 + pointer_bytes())
                return malformed(fmt::format("the values of tag {} lie in the directory", entry.tag));
            entries_.push_back(entry);
        }
        return {};
    }

    /// Nothing, where they do not lie in the file.
    [[nodiscard]] std::span<const std::byte> bytes_of(const Entry& entry) const {
        const std::uint64_t size = size_of_type(entry.type);
        if (size == 0 || entry.count > file_.size() / size) return {};
        const std::uint64_t bytes = entry.count * size;
        const std::uint64_t at = bytes > pointer_bytes() ? number(entry.values, pointer_bytes()) : entry.values;
        return fits(at, bytes) ? file_.subspan(at, bytes) : std::span<const std::byte>();
    }

    [[nodiscard]] std::size_t pointer_bytes() const { return is_big_tiff_ ? 8 : 4; }
    [[nodiscard]] std::size_t count_bytes() const { return is_big_tiff_ ? 8 : 2; }
    [[nodiscard]] std::size_t entry_bytes() const { return is_big_tiff_ ? 20 : 12; }
    [[nodiscard]] const Entry* find(std::uint32_t tag) const {
        const auto found = std::ranges::find(entries_, tag, &Entry::tag);
        return found == entries_.end() ? nullptr : &*found;
    }
    [[nodiscard]] std::uint64_t value(const Entry& entry, std::uint64_t index) const {
        const std::size_t size = size_of_type(entry.type);
        return number(entry.values + index * size, size);
    }
    /// Of a tag whose values count something.
    Result<std::uint64_t> count_of(std::uint32_t tag, std::uint64_t otherwise, std::uint64_t most) const {
        const Entry* const entry = find(tag);
        if (entry == nullptr && otherwise != 0) return otherwise;
        if (entry == nullptr) return failure(malformed(fmt::format("tag {} is missing", tag)).error());
        if (!is_whole(*entry)) return failure(malformed(fmt::format("tag {} is not a whole number", tag)).error());
        const std::uint64_t out = value(*entry, 0);
        if (out < 1 || out > most)
            return failure(malformed(fmt::format("tag {} is {}, [1, {}] is allowed", tag, out, most)).error());
        return out;
    }
    // Bytes, shorts, longs, and longs of 8 bytes.
    static bool is_whole(const Entry& entry) {
        return entry.type == 1 || entry.type == 3 || entry.type == 4 || entry.type == 16;
    }

    Result<> check_picture() {
        constexpr std::uint64_t any = 0xffffffffU;
        struct Field {
            std::uint64_t* to;
            std::uint32_t tag;
            std::uint64_t otherwise, most;
        };
        for (const Field& field :
             {Field{&width_, image_width, 0, any}, Field{&height_, image_length, 0, any},
              Field{&bits_, bits_per_sample, 1, 64}, Field{&samples_, samples_per_pixel, 1, max_samples},
              Field{&compression_, compression_tag, uncompressed, 65535}, Field{&planar_, planar_configuration, 1, 2},
              Field{&rows_, rows_per_strip, any, any}}) {
            DARKROOM_TRY_VALUE(const std::uint64_t read, count_of(field.tag, field.otherwise, field.most));
            *field.to = read;
        }
        constexpr auto most = static_cast<std::uint64_t>(max_picture_side);
        if (std::max(width_, height_) > most)
            return user_error(fmt::format("the picture is {}x{}, [1, {}] a side is allowed", width_, height_, most));
        if (std::ranges::find(known_compressions, compression_) == known_compressions.end())
            return user_error(fmt::format(
                "compression {}: none, fax, LZW, JPEG, Deflate, PackBits or Zstandard is read here", compression_));
        const Entry* const bits = find(bits_per_sample);
        for (std::uint64_t i = 1; bits != nullptr && i < std::min(samples_, bits->count); ++i)
            if (value(*bits, i) != bits_) return malformed("samples of different numbers of bits");
        DARKROOM_TRY(check_format());
        return check_palette();
    }

    /// Decoders take what they do not know for something else: floats of 24 bits for whole numbers, 6 bits for 8.
    Result<> check_format() const {
        constexpr std::array<std::string_view, 6> names{
            "whole numbers",      "signed whole numbers",  "floats",
            "numbers of no kind", "complex whole numbers", "complex floats"};
        const Entry* const entry = find(sample_format);
        const std::uint64_t format = entry == nullptr || !is_whole(*entry) ? 1 : value(*entry, 0);
        for (std::uint64_t i = 1; entry != nullptr && i < std::min(samples_, entry->count); ++i)
            if (value(*entry, i) != format) return malformed("samples of different kinds");
        constexpr std::array<std::uint64_t, 8> whole{1, 2, 4, 8, 10, 12, 14, 16};
        const Entry* const meaning = find(photometric);
        // CIE L*a*b*, with numbers of either sign or none, or of the ITU: decoders take one for another.
        if (meaning != nullptr && is_whole(*meaning) && value(*meaning, 0) >= 8 && value(*meaning, 0) <= 10)
            return user_error("its colours are CIE L*a*b*, which is not read here: save it as RGB");
        // White or black at 0, RGB, a palette, a mask, inks, YCbCr.
        if (meaning != nullptr && is_whole(*meaning) && value(*meaning, 0) > 6)
            return user_error(fmt::format(
                "the meaning {} of its samples{}, which is not read here: save it as RGB", value(*meaning, 0),
                value(*meaning, 0) == 32803 || value(*meaning, 0) == 34892 ? " (numbers of a camera's sensor)" : ""));
        const bool is_negative = meaning != nullptr && is_whole(*meaning) && value(*meaning, 0) == 0;
        const bool is_known_whole = std::ranges::count(whole, bits_) > 0 && !(is_negative && bits_ > 8 && bits_ < 16);
        if (format == 3 ? bits_ == 16 || bits_ == 32 : format == 1 ? is_known_whole : format == 4 && bits_ == 8)
            return {};
        return user_error(fmt::format(
            "{} of {} bits{}; whole numbers of 1, 2, 4, 8, 10, 12, 14 or 16 bits and floats of 16 or 32 are read",
            format >= 1 && format <= names.size() ? names[format - 1] : "samples of an unknown kind", bits_,
            is_negative ? ", of which 0 is white" : ""));
    }

    Result<> check_palette() const {
        const Entry* const meaning = find(photometric);
        if (meaning == nullptr || !is_whole(*meaning)) return malformed("tag 262 (what samples mean) is missing");
        if (value(*meaning, 0) != 3) return {};
        const Entry* const map = find(color_map);
        if (bits_ > 8 || samples_ != 1 || map == nullptr || map->type != 3 || map->count != std::uint64_t{3} << bits_)
            return malformed(fmt::format("a palette for {} samples of {} bits must have {} numbers", samples_, bits_,
                                         std::uint64_t{3} << std::min<std::uint64_t>(bits_, 16)));
        return {};
    }

    // Rows of samples, or of blocks that share their chroma.
    [[nodiscard]] std::uint64_t bytes_of(std::uint64_t width, std::uint64_t height) const {
        const Entry* const meaning = find(photometric);
        if (compression_ == uncompressed && planar_ == 1 && samples_ == 3 && value(*meaning, 0) == 6) {
            const Entry* const entry = find(ycbcr_subsampling);
            const bool is_given = entry != nullptr && entry->count == 2 && is_whole(*entry);
            const std::uint64_t across = is_given ? std::clamp<std::uint64_t>(value(*entry, 0), 1, 4) : 2;
            const std::uint64_t down = is_given ? std::clamp<std::uint64_t>(value(*entry, 1), 1, 4) : 2;
            const std::uint64_t blocks = (width + across - 1) / across * ((height + down - 1) / down);
            return (blocks * (across * down + 2) * bits_ + 7) / 8;
        }
        return (width * bits_ * (planar_ == 1 ? samples_ : 1) + 7) / 8 * height;
    }

    Result<> check_chunks() {
        const bool is_tiled = find(tile_width) != nullptr || find(tile_length) != nullptr;
        const char* const what = is_tiled ? "tile" : "strip";
        chunk_width_ = width_;
        chunk_height_ = std::min(rows_, height_);
        if (is_tiled) {
            const Result<std::uint64_t> across = count_of(tile_width, 0, max_tile_side);
            const Result<std::uint64_t> down = count_of(tile_length, 0, max_tile_side);
            if (!across || !down) {
                const Entry *const wide = find(tile_width), *const high = find(tile_length);
                if (wide == nullptr || high == nullptr) return malformed("a tile without a width or a height");
                return user_error(fmt::format("tiles of {}x{}, [1, {}] a side is allowed", value(*wide, 0),
                                              value(*high, 0), max_tile_side));
            }
            chunk_width_ = *across;
            chunk_height_ = *down;
        }
        const std::uint64_t columns = (width_ + chunk_width_ - 1) / chunk_width_;
        const std::uint64_t lines = (height_ + chunk_height_ - 1) / chunk_height_;
        const std::uint64_t planes = planar_ == 2 ? samples_ : 1;
        const std::uint64_t chunk_bytes = bytes_of(chunk_width_, chunk_height_);
        // A decoder takes a tile several times over, however little of it is in the picture. Sides are multiples of 16.
        const auto rounded = [](std::uint64_t side) { return (side + 15) / 16 * 16; };
        const std::uint64_t max_bytes =
            std::clamp(bytes_of(rounded(width_), rounded(height_)), always_tile_bytes, max_tile_bytes);
        if (is_tiled && chunk_bytes > max_bytes)
            return user_error(fmt::format("tiles of {}x{} pixels need {} bytes each, at most {} are allowed",
                                          chunk_width_, chunk_height_, chunk_bytes, max_bytes));
        DARKROOM_TRY(check_decoded_size(chunk_bytes * (is_tiled ? columns * lines : 1) * planes, file_.size()));
        DARKROOM_TRY(check_decoded_size((width_ * samples_ * bits_ + 7) / 8 * height_, file_.size()));

        const Entry* const offsets = find(is_tiled ? tile_offsets : strip_offsets);
        const Entry* const sizes = find(is_tiled ? tile_byte_counts : strip_byte_counts);
        const std::uint64_t count = columns * lines * planes;
        for (const Entry* const list : {offsets, sizes})
            if (list == nullptr || !is_whole(*list) || list->count < count)
                return user_error(fmt::format("{} {}s in a list of {}: truncated, or a damaged header", count, what,
                                              list == nullptr ? 0 : list->count));
        JpegScans scans;
        std::uint64_t total = 0;
        for (std::uint64_t i = 0; i < count; ++i) {
            const std::uint64_t at = value(*offsets, i), size = value(*sizes, i);
            const std::uint64_t rows = std::min(chunk_height_, height_ - i / columns % lines * chunk_height_);
            const std::uint64_t needed =
                compression_ == uncompressed ? bytes_of(chunk_width_, is_tiled ? chunk_height_ : rows) : 1;
            if (at < 8 || !fits(at, size))
                return user_error(fmt::format("truncated: {} {} of {} lies at byte {}, outside the file of {} bytes",
                                              what, i + 1, count, at, file_.size()));
            if (overlaps_directory(at, size))
                return malformed(fmt::format("{} {} of {} lies in the directory", what, i + 1, count));
            total += size;
            if (total > file_.size() * max_uses_of_bytes)
                return user_error(fmt::format("{}s of {} bytes and more in a file of {}: they share too many", what,
                                              total, file_.size()));
            if (size < needed)
                return user_error(
                    fmt::format("truncated: {} {} of {} has {} bytes of {}", what, i + 1, count, size, needed));
            if (compression_ != jpeg_compressed) continue;
            DARKROOM_TRY(scans.add(file_.subspan(at, size)));
        }
        return {};
    }

    /// The entries that were read take the first places, and no other picture comes before it or follows. A file that
    /// does not say how many bits its samples have says that it is one, for which some decoders take eight.
    [[nodiscard]] std::vector<std::byte> cleaned() const {
        std::vector<std::byte> out(file_.begin(), file_.end());
        std::vector<const Entry*> sorted;
        for (const Entry& entry : entries_) sorted.push_back(&entry);
        std::ranges::sort(sorted, {}, [](const Entry* entry) { return entry->tag; });
        std::fill(out.begin() + static_cast<std::ptrdiff_t>(directory_),
                  out.begin() + static_cast<std::ptrdiff_t>(tags_end_ + pointer_bytes()), std::byte{0});
        bool needs_bits = find(bits_per_sample) == nullptr;
        const std::size_t count = sorted.size() + (needs_bits ? 1 : 0), bytes = count * entry_bytes();
        std::size_t place = directory_ - count_bytes();
        if (bytes > tags_end_ - directory_) {
            place = out.size() + out.size() % 2;
            out.resize(place + count_bytes() + bytes + pointer_bytes());
        }
        const auto put = [&](std::size_t at, std::uint64_t number, std::size_t size) {
            for (std::size_t i = 0; i < size; ++i)
                out[at + i] = static_cast<std::byte>(number >> 8 * (is_little_ ? i : size - 1 - i) & 0xff);
        };
        std::size_t to = place + count_bytes();
        const auto put_bits = [&] {
            constexpr std::uint64_t short_type = 3;
            put(to, bits_per_sample, 2);
            put(to + 2, short_type, 2);
            put(to + 4, 1, pointer_bytes());
            put(to + 4 + pointer_bytes(), 1, 2);
            to += entry_bytes();
            needs_bits = false;
        };
        for (const Entry* const entry : sorted) {
            if (needs_bits && entry->tag > bits_per_sample) put_bits();
            std::memcpy(out.data() + to, file_.data() + entry->at, entry_bytes());
            to += entry_bytes();
        }
        if (needs_bits) put_bits();
        put(place, count, count_bytes());
        put(pointer_bytes(), place, pointer_bytes());
        return out;
    }

    std::span<const std::byte> file_, profile_;
    bool is_little_ = true, is_big_tiff_ = false;
    std::size_t directory_ = 0, tags_end_ = 0;
    std::vector<Entry> entries_;
    std::vector<Page> pages_;
    bool has_more_pages_ = false;
    std::uint64_t width_ = 0, height_ = 0, bits_ = 0, samples_ = 0, compression_ = 0, planar_ = 0, rows_ = 0;
    std::uint64_t chunk_width_ = 0, chunk_height_ = 0;
};

}  // namespace

Result<std::vector<std::byte>> check_tiff(std::span<const std::byte> file) { return TiffChecker(file).run(); }

std::span<const std::byte> profile_of_tiff(std::span<const std::byte> file) { return TiffChecker(file).profile(); }

std::string left_out_of_tiff(std::span<const std::byte> file) { return TiffChecker(file).left_out(); }

}  // namespace darkroom
