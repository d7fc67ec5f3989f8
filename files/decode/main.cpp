// SPDX-License-Identifier: MIT
// darkroom_decode [MODULE]: decodes pictures for the program that started it (image/confined/decoder_pool.hpp), by
// what reads their formats, and where it names the module, by OpenImageIO. A process of its own,
// which opens no file, no connection and no process, whatever a picture makes of a decoder: pictures and their samples
// are in memory that the program shares with it.
#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <vector>

#include "confined/exchange.hpp"
#include "confined/inside/confine.hpp"
#include "confined/inside/serve.hpp"
#include "confined/messages.hpp"
#include "confined/shared_memory.hpp"
#include "formats/file_format.hpp"
#include "formats/messages.hpp"
#include "image/codec/codecs.hpp"

namespace darkroom {
namespace {

const Codecs* module_codecs = nullptr;

/// Empty: loaded. Later it could open nothing.
std::string load(const char* module) {
    void* const opened = dlopen(module, RTLD_NOW | RTLD_LOCAL);
    void* const found = opened == nullptr ? nullptr : dlsym(opened, "darkroom_oiio_codecs");
    if (found == nullptr) {
        const char* const why = dlerror();
        return std::string("OpenImageIO cannot be loaded: ") + (why == nullptr ? module : why);
    }
    module_codecs = reinterpret_cast<const Codecs* (*)()>(found)();
    module_codecs->prepare();
    return {};
}

/// Nothing: by OpenImageIO alone, which is not here.
Result<std::unique_ptr<PictureSource>> open(const FileFormat& format, std::span<const std::byte> bytes,
                                            std::size_t max_threads) {
    std::unique_ptr<PictureSource> source;
    if (format.open != nullptr) {
        DARKROOM_TRY_VALUE(source, format.open(bytes, max_threads));
    }
    if (source == nullptr && module_codecs != nullptr) return module_codecs->open(format, bytes);
    return source;
}

/// The picture that was asked for last: most are read in several requests.
struct Picture {
    std::uint64_t number = 0;
    Mapping bytes;
    std::unique_ptr<PictureSource> source;  // after `bytes`
};

PictureDescription describe(const PictureSource& source) {
    PictureDescription out;
    for (std::size_t i = 0; i < source.parts().size(); ++i) {
        auto& part = out.parts.emplace_back(PictureDescription::Part{source.parts()[i], source.row_unit(i), {}});
        for (const std::string& name : source.attributes(i)) part.attributes.push_back({name, source.numbers(i, name)});
    }
    return out;
}

Result<> read(PictureSource& source, const DecodeRequest& request, std::span<const DecodePlace> wanted,
              std::span<std::byte> memory) {
    std::size_t widest = 1;
    for (const DecodePlace& place : wanted) widest = std::max(widest, size_of(static_cast<SampleKind>(place.kind)));
    const std::size_t pixel = widest * wanted.size(), row = pixel * source.parts()[request.part].width;
    std::vector<SamplePlace> places;
    for (std::size_t i = 0; i < wanted.size(); ++i)
        places.push_back({.channel = wanted[i].channel,
                          .kind = static_cast<SampleKind>(wanted[i].kind),
                          .first = memory.data() + i * widest,
                          .pixel_bytes = static_cast<std::ptrdiff_t>(pixel),
                          .row_bytes = static_cast<std::ptrdiff_t>(row)});
    return source.read_rows(request.part, request.row, request.rows, places);
}

class Server {
  public:
    /// False: nobody asks any more.
    [[nodiscard]] bool serve_one() {
        DecodeRequest request;
        std::vector<Descriptor> files;
        if (!receive_all(socket_of_program, &request, sizeof request, &files)) return false;
        std::vector<DecodePlace> places(request.place_count);
        if (!receive_all(socket_of_program, places.data(), places.size() * sizeof(DecodePlace))) return false;
        alarm(request.max_seconds);
        std::vector<std::byte> description;
        Result<> done;
        try {
            done = answer(request, places, files, description);
        } catch (const std::bad_alloc&) {
            done = user_error("takes more memory to decode than its size allows");
        } catch (const std::exception& exception) {
            done = user_error("cannot be read as " + std::string(all_formats()[request.format]->name) + ": " +
                              one_printable_line(exception.what()));
        }
        if (!done) picture_ = {};
        alarm(0);
        const std::string error = done ? std::string() : done.error().text.substr(0, max_error_bytes);
        const DecodeReply reply{.outcome = !done                        ? DecodeOutcome::Error
                                           : picture_.source == nullptr ? DecodeOutcome::NeedsOpenImageIo
                                                                        : DecodeOutcome::Done,
                                .size = static_cast<std::uint32_t>(done ? description.size() : error.size())};
        return send_all(socket_of_program, &reply, sizeof reply) &&
               send_all(socket_of_program, description.data(), done ? description.size() : 0) &&
               send_all(socket_of_program, error.data(), error.size());
    }

  private:
    [[nodiscard]] Result<> answer(const DecodeRequest& request, std::span<const DecodePlace> places,
                                  std::span<Descriptor> files, std::vector<std::byte>& description) {
        std::size_t next = 0;
        if (request.file_size > 0) {
            picture_ = {};
            picture_.bytes = Mapping(files[next++].number(), request.file_size, false);
            if (picture_.bytes.bytes().empty()) throw std::bad_alloc();
            DARKROOM_TRY_VALUE(picture_.source,
                               open(*all_formats()[request.format], picture_.bytes.bytes(), request.max_threads));
            picture_.number = request.source;
        }
        if (request.memory_size > 0) {
            memory_ = {};
            memory_ = Mapping(files[next++].number(), request.memory_size, true);
            if (memory_.bytes().empty()) throw std::bad_alloc();
        }
        if (picture_.source == nullptr) return {};
        if (request.rows > 0) return read(*picture_.source, request, places, memory_.bytes());
        description = packed(describe(*picture_.source));
        return {};
    }

    Picture picture_;
    Mapping memory_;
};

}  // namespace
}  // namespace darkroom

int main(int count, char** arguments) {
    using namespace darkroom;
    const std::span<const char* const> given(arguments + 1, static_cast<std::size_t>(count - 1));
    const bool has_module = !given.empty() && given[0] != allow_unconfined_flag;
    std::string error = has_module ? load(given[0]) : std::string();
    if (const std::string why = why_not_confined(confine({}), given); !why.empty()) error = why;
    if (greet(error) && error.empty()) {
        Server server;
        while (server.serve_one()) {
        }
    }
    _exit(0);  // libraries have nothing to write at the end, and could not
}
