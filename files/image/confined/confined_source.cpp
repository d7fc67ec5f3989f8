// SPDX-License-Identifier: MIT
#include "image/confined/confined_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>

#include "confined/messages.hpp"
#include "core/text/lower.hpp"
#include "image/confined/decoder_pool.hpp"

namespace darkroom {
namespace {

/// How many samples are handed over at a time, unless rows that belong together have more.
constexpr std::size_t usual_memory = std::size_t{16} << 20;
/// A picture is decoded in a second for each of so many bytes of samples, on a machine with much else to do.
constexpr std::uint64_t bytes_of_a_second = std::uint64_t{4} << 20;

std::size_t widest_of(std::span<const SamplePlace> places) {
    std::size_t out = 1;
    for (const SamplePlace& place : places) out = std::max(out, size_of(place.kind));
    return out;
}

template <std::size_t Size>
void copy_samples(const std::byte* from, std::size_t step, std::byte* to, std::ptrdiff_t pixel_bytes,
                  std::size_t count) {
    for (std::size_t x = 0; x < count; ++x, from += step, to += pixel_bytes) std::memcpy(to, from, Size);
}

/// From the order of messages.hpp to the places.
void scatter(std::span<const std::byte> samples, std::size_t width, std::uint32_t rows,
             std::span<const SamplePlace> places) {
    const std::size_t widest = widest_of(places), pixel = widest * places.size();
    const auto is_same = [&](const SamplePlace& place) {
        const auto i = static_cast<std::size_t>(&place - places.data());
        return size_of(place.kind) == widest && place.first == places[0].first + i * widest &&
               place.pixel_bytes == static_cast<std::ptrdiff_t>(pixel) && place.row_bytes == places[0].row_bytes;
    };
    const bool is_copied = std::ranges::all_of(places, is_same);
    for (std::uint32_t y = 0; y < rows; ++y) {
        const std::byte* const row = samples.data() + pixel * width * y;
        if (is_copied) {
            std::memcpy(places[0].first + y * places[0].row_bytes, row, pixel * width);
            continue;
        }
        for (std::size_t i = 0; i < places.size(); ++i) {
            const SamplePlace& place = places[i];
            std::byte* const to = place.first + static_cast<std::ptrdiff_t>(y) * place.row_bytes;
            const std::size_t size = size_of(place.kind);
            const auto copy = size == 1 ? copy_samples<1> : size == 2 ? copy_samples<2> : copy_samples<4>;
            copy(row + i * widest, pixel, to, place.pixel_bytes, width);
        }
    }
}

/// A process of the pool for as long as it is needed.
class Lease {
  public:
    explicit Lease(DecoderProcess& process) : process_(process) {}
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    ~Lease() { DecoderPool::shared().give_back(process_); }

  private:
    DecoderProcess& process_;
};

std::uint32_t number_of(const FileFormat& format) {
    return static_cast<std::uint32_t>(std::ranges::find(all_formats(), &format) - all_formats().begin());
}

std::uint64_t next_number() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

}  // namespace

ConfinedSource::ConfinedSource(const FileFormat& format, std::span<const std::byte> bytes, std::size_t max_threads)
    : format_(format),
      needs_openimageio_(format.open == nullptr),
      file_(bytes),
      max_threads_(static_cast<std::uint32_t>(max_threads)),
      number_(next_number()) {}

Result<std::unique_ptr<PictureSource>> ConfinedSource::open(const FileFormat& format, std::span<const std::byte> bytes,
                                                            std::size_t max_threads) {
    std::unique_ptr<ConfinedSource> out(new ConfinedSource(format, bytes, max_threads));
    std::vector<std::byte> answer;
    const bool is_sure = out->needs_openimageio_;
    auto asked = out->ask(0, 0, 0, {}, answer);
    if (asked && out->needs_openimageio_ != is_sure) asked = out->ask(0, 0, 0, {}, answer);
    if (!asked) return failure(std::move(asked));
    auto description = unpacked(answer);
    if (!description) return user_error(fmt::format("cannot be read as {}: its decoder fails", format.name));
    out->description_ = std::move(*description);
    for (const auto& part : out->description_.parts) out->parts_.push_back(part.part);
    return std::unique_ptr<PictureSource>(std::move(out));
}

std::vector<double> ConfinedSource::numbers(std::size_t part, std::string_view attribute) const {
    for (const auto& [name, values] : description_.parts[part].attributes)
        if (lower(name) == lower(attribute)) return values;
    return {};
}

std::vector<std::string> ConfinedSource::attributes(std::size_t part) const {
    std::vector<std::string> out;
    for (const auto& attribute : description_.parts[part].attributes) out.push_back(attribute.name);
    return out;
}

std::uint32_t ConfinedSource::row_unit(std::size_t part) const { return description_.parts[part].row_unit; }

std::uint64_t ConfinedSource::decoded_size() const {
    std::uint64_t out = 0;
    for (const FilePart& part : parts())
        out += std::uint64_t{4} * std::max<std::size_t>(part.channels.size(), 4) * part.width * part.height;
    return out;
}

Result<> ConfinedSource::read(std::size_t part, std::uint32_t row, std::uint32_t rows,
                              std::span<const SamplePlace> places) {
    if (places.size() > max_places)
        return user_error(fmt::format("{} channels at once: allowed are {}", places.size(), max_places));
    const std::size_t width = parts()[part].width, row_bytes = widest_of(places) * places.size() * width;
    const std::uint32_t unit = row_unit(part);
    const std::size_t fitting = std::max<std::size_t>(usual_memory / row_bytes / unit * unit, unit);
    std::vector<std::byte> nothing;
    std::vector<SamplePlace> band(places.begin(), places.end());
    for (const std::uint32_t end = row + rows; row < end;) {
        // Up to where a unit ends.
        const auto stop = static_cast<std::uint32_t>(std::min<std::size_t>(end, row / unit * unit + fitting));
        DARKROOM_TRY(ask(part, row, stop - row, band, nothing));
        for (SamplePlace& place : band) place.first += static_cast<std::ptrdiff_t>(stop - row) * place.row_bytes;
        row = stop;
    }
    return {};
}

Result<> ConfinedSource::ask(std::size_t part, std::uint32_t row, std::uint32_t rows,
                             std::span<const SamplePlace> places, std::vector<std::byte>& answer) {
    DARKROOM_TRY_VALUE(const auto taken, DecoderPool::shared().take(number_, needs_openimageio_));
    DecoderProcess& decoder = *taken;
    const Lease lease(decoder);
    ConfinedProcess& process = decoder.process;

    const std::size_t size =
        rows == 0 ? 0 : widest_of(places) * places.size() * parts()[part].width * std::size_t{rows};
    DecodeRequest request{.source = number_,
                          .format = number_of(format_),
                          .max_threads = max_threads_,
                          .part = static_cast<std::uint32_t>(part),
                          .row = row,
                          .rows = rows,
                          .place_count = static_cast<std::uint32_t>(places.size())};
    SharedMemory file;
    std::vector<int> descriptors;
    if (decoder.source != number_) {
        DARKROOM_TRY_VALUE(file, SharedMemory::holding(file_));
        descriptors.push_back(file.descriptor());
        request.file_size = file_.size();
        decoder.source = number_;
    }
    if (decoder.memory.size() < size) {
        decoder.samples = {};
        DARKROOM_TRY_VALUE(decoder.memory, SharedMemory::make(std::max(size, std::min(usual_memory, 2 * size))));
        decoder.samples = Mapping(decoder.memory.descriptor(), decoder.memory.size(), false);
        descriptors.push_back(decoder.memory.descriptor());
        request.memory_size = decoder.memory.size();
    }
    if (decoder.samples.bytes().size() < size) {
        decoder.memory = {};
        process.stop();
        return machine_error(fmt::format("no room for {} bytes of samples", size));
    }
    const DecoderPool& pool = DecoderPool::shared();
    const std::uint64_t decoded = decoded_size();
    request.max_seconds = pool.seconds + static_cast<std::uint32_t>(decoded / bytes_of_a_second);
    process.limit_wait(request.max_seconds + 1);
    process.limit_memory(pool.memory_at_rest + 2 * file_.size() + pool.memory_of_a_byte * decoded + size);

    std::vector<DecodePlace> wanted;
    for (const SamplePlace& place : places)
        wanted.push_back({static_cast<std::uint32_t>(place.channel), static_cast<std::uint32_t>(place.kind)});
    DecodeReply reply;
    bool is_answered = process.send(&request, sizeof request, descriptors) &&
                       process.send(wanted.data(), wanted.size() * sizeof(DecodePlace)) &&
                       process.receive(&reply, sizeof reply) && reply.outcome <= DecodeOutcome::NeedsOpenImageIo &&
                       reply.size <= (reply.outcome == DecodeOutcome::Error ? max_error_bytes : max_reply_bytes);
    if (is_answered) {
        answer.resize(reply.size);
        is_answered = process.receive(answer.data(), answer.size());
    }
    if (!is_answered) return user_error(fmt::format("cannot be decoded: its decoder {}", process.stop()));
    if (reply.outcome == DecodeOutcome::NeedsOpenImageIo) {
        decoder.source = 0;
        if (needs_openimageio_ || rows > 0) return user_error("cannot be decoded: its decoder fails");
        needs_openimageio_ = true;
        return {};
    }
    if (reply.outcome == DecodeOutcome::Error) {
        decoder.source = 0;
        return user_error(one_printable_line({reinterpret_cast<const char*>(answer.data()), answer.size()}));
    }
    if (rows > 0) scatter(decoder.samples.bytes().first(size), parts()[part].width, rows, places);
    if (decoder.memory.size() > 2 * usual_memory) {
        // The next request brings less; the process lets go of it then.
        decoder.samples = {};
        decoder.memory = {};
    }
    return {};
}

}  // namespace darkroom
