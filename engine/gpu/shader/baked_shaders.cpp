// SPDX-License-Identifier: MIT
#include "gpu/shader/baked_shaders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "core/hash.hpp"

namespace darkroom::gpu {

namespace {

constexpr std::array<char, 8> file_magic{'d', 'k', 'b', ' ', 'S', 'P', 'V', '\n'};
constexpr std::uint32_t file_version = 1;
constexpr std::uint32_t profile_count = 2;
constexpr std::uint32_t spirv_magic = 0x07230203;
constexpr std::size_t spirv_header_words = 5;

struct Head {
    std::array<char, 8> magic = file_magic;
    std::uint32_t version = file_version, profile = 0, count = 0;
    std::uint32_t bytes = 0;  ///< of all kernels together
    Hash content{};           ///< of all behind the head
};
static_assert(sizeof(Head) == 40);

/// Kernels follow each other in the order of the index.
struct IndexEntry {
    Digest text{};
    std::uint32_t stage = 0, words = 0, place = 0;

    [[nodiscard]] ShaderKey key() const { return {text, static_cast<ShaderStage>(stage)}; }
};
static_assert(sizeof(IndexEntry) == 44);

template <class T>
T read_at(std::span<const std::byte> file, std::size_t place) {
    T out;
    std::memcpy(&out, file.data() + place, sizeof out);
    return out;
}
IndexEntry index_entry(std::span<const std::byte> file, std::size_t number) {
    return read_at<IndexEntry>(file, sizeof(Head) + number * sizeof(IndexEntry));
}

Result<> check_head(const Head& head, std::span<const std::byte> file) {
    if (head.version != file_version)
        return user_error(
            fmt::format("baked kernels: they are of version {}; allowed is {}", head.version, file_version));
    if (head.profile >= profile_count)
        return user_error(
            fmt::format("baked kernels: profile {}: allowed is 0 to {}", head.profile, profile_count - 1));
    if (head.count > BakedShaders::max_shaders)
        return user_error(fmt::format("baked kernels: they say that they are {}; allowed is at most {}", head.count,
                                      BakedShaders::max_shaders));
    const std::uint64_t wanted = sizeof(Head) + std::uint64_t{head.count} * sizeof(IndexEntry) + head.bytes;
    if (wanted != file.size())
        return user_error(fmt::format("baked kernels: {} kernels in {} bytes are a file of {}, but {} bytes are there",
                                      head.count, head.bytes, wanted, file.size()));
    if (content_hash(file.subspan(sizeof(Head))) != head.content)
        return user_error("baked kernels: they are damaged: their hash is another");
    return {};
}

// A word is as many bytes as it needs, seven bits each, the lowest first; all but the last have the eighth bit. Most
// words are numbers of values and types, so a kernel takes half the room.
void append_word(std::vector<std::byte>& out, std::uint32_t word) {
    for (; word >= 0x80; word >>= 7) out.push_back(static_cast<std::byte>(word | 0x80));
    out.push_back(static_cast<std::byte>(word));
}

/// Moves `place` behind it. None: the bytes end, or are no word.
std::optional<std::uint32_t> take_word(std::span<const std::byte> bytes, std::size_t& place) {
    std::uint64_t word = 0;
    for (std::uint32_t shift = 0; shift < 35 && place < bytes.size(); shift += 7) {
        const auto byte = std::to_integer<std::uint64_t>(bytes[place++]);
        word |= (byte & 0x7f) << shift;
        if (byte >= 0x80) continue;
        if (word > ~std::uint32_t{0}) return std::nullopt;
        return static_cast<std::uint32_t>(word);
    }
    return std::nullopt;
}

/// One that begins at `place`, which is moved behind it. The error says what of it is wrong.
Result<> check_kernel(std::span<const std::byte> file, std::size_t number, std::size_t& place) {
    const IndexEntry entry = index_entry(file, number);
    if (entry.stage > static_cast<std::uint32_t>(ShaderStage::Compute))
        return user_error(fmt::format("stage {}: allowed is 0 to 2", entry.stage));
    if (number > 0 && entry.key() <= index_entry(file, number - 1).key()) return user_error("it is out of order");
    if (entry.place != place) return user_error(fmt::format("place {}: allowed is {}", entry.place, place));
    const std::size_t left = file.size() - place;
    if (entry.words < spirv_header_words || entry.words > left)
        return user_error(fmt::format("{} words: allowed is {} to one for each of the {} bytes that are left",
                                      entry.words, spirv_header_words, left));
    for (std::uint32_t i = 0; i < entry.words; ++i) {
        const std::optional<std::uint32_t> word = take_word(file, place);
        if (!word) return user_error("its words end too early");
        if (i == 0 && *word != spirv_magic)
            return user_error(fmt::format("its words are not SPIR-V: they begin with {:#010x}", *word));
    }
    return {};
}

}  // namespace

std::string_view profile_name(DeviceProfile profile) { return profile == DeviceProfile::Software ? "software" : "gpu"; }

Result<BakedShaders> BakedShaders::read(std::span<const std::byte> file) {
    if (file.size() > max_bytes)
        return user_error(
            fmt::format("baked kernels: {} bytes; allowed is at most {}", file.size(), std::size_t{max_bytes}));
    if (file.size() < sizeof(Head) || read_at<Head>(file, 0).magic != file_magic)
        return user_error("baked kernels: the bytes are not a file that 'darkroom bake' wrote");
    const auto head = read_at<Head>(file, 0);
    DARKROOM_TRY(check_head(head, file));
    std::size_t place = sizeof(Head) + head.count * sizeof(IndexEntry);
    for (std::size_t i = 0; i < head.count; ++i)
        if (Result<> checked = check_kernel(file, i, place); !checked)
            return user_error(
                fmt::format("baked kernels: kernel {} of {}: {}", i + 1, head.count, checked.error().text));
    if (place != file.size())
        return user_error(fmt::format("baked kernels: {} bytes after the last kernel", file.size() - place));
    BakedShaders out;
    out.file_.assign(file.begin(), file.end());
    out.count_ = head.count;
    out.profile_ = static_cast<DeviceProfile>(head.profile);
    return out;
}

std::optional<std::vector<std::uint32_t>> BakedShaders::find(const Digest& text, ShaderStage stage) const {
    const ShaderKey wanted(text, stage);
    std::size_t first = 0, last = count_;
    while (first < last) {
        const std::size_t middle = first + (last - first) / 2;
        if (index_entry(file_, middle).key() < wanted)
            first = middle + 1;
        else
            last = middle;
    }
    if (first == count_) return std::nullopt;
    const IndexEntry entry = index_entry(file_, first);
    if (entry.key() != wanted) return std::nullopt;
    std::vector<std::uint32_t> words(entry.words);
    std::size_t place = entry.place;
    for (std::uint32_t& word : words) word = *take_word(file_, place);
    return words;
}

std::vector<std::byte> ShadersToBake::bytes() const {
    Head head{.profile = static_cast<std::uint32_t>(profile), .count = static_cast<std::uint32_t>(words.size())};
    std::size_t place = sizeof(Head);
    std::vector<std::byte> out(place + head.count * sizeof(IndexEntry));
    const std::size_t index_end = out.size();
    for (const auto& [key, kernel] : words) {
        const IndexEntry entry{key.first, static_cast<std::uint32_t>(key.second),
                               static_cast<std::uint32_t>(kernel.size()), static_cast<std::uint32_t>(out.size())};
        std::memcpy(out.data() + place, &entry, sizeof entry);
        place += sizeof entry;
        for (const std::uint32_t word : kernel) append_word(out, word);
    }
    head.bytes = static_cast<std::uint32_t>(out.size() - index_end);
    head.content = content_hash(std::span<const std::byte>(out).subspan(sizeof(Head)));
    std::memcpy(out.data(), &head, sizeof head);
    return out;
}

}  // namespace darkroom::gpu
