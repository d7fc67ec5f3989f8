// SPDX-License-Identifier: MIT
// darkroom_svg: draws SVG documents for the program that started it (hud/svg_process.hpp), by librsvg. A process of its
// own, so that no document can hold up that program, take its memory or read files: it has no base for references, and
// the process is confined before it reads a document (confined/inside/confine.hpp). Fonts are what it may read.
#include <fontconfig/fontconfig.h>
#include <librsvg/rsvg.h>
#include <unistd.h>

#include <memory>
#include <string>
#include <vector>

#include "confined/exchange.hpp"
#include "confined/inside/confine.hpp"
#include "confined/inside/serve.hpp"
#include "confined/shared_memory.hpp"
#include "hud/svg_messages.hpp"

namespace darkroom {
namespace {

struct Free {
    void operator()(GError* error) const { g_error_free(error); }
    void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* context) const { cairo_destroy(context); }
};
template <class T>
using Owned = std::unique_ptr<T, Free>;

std::string text_of(GError* error) {
    const Owned<GError> owned(error);
    return error == nullptr ? "it cannot be drawn" : error->message;
}

/// Cairo's pixels are words, alpha uppermost.
void write_pixels(const cairo_surface_t* surface, const SvgRequest& request, std::uint8_t* out) {
    auto* const image = const_cast<cairo_surface_t*>(surface);
    const unsigned char* const data = cairo_image_surface_get_data(image);
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(image));
    for (std::size_t y = 0; y < request.height; ++y) {
        const auto* row = reinterpret_cast<const std::uint32_t*>(data + y * stride);
        for (std::size_t x = 0; x < request.width; ++x, out += 4) {
            const std::uint32_t pixel = row[x];
            out[0] = static_cast<std::uint8_t>(pixel >> 16);
            out[1] = static_cast<std::uint8_t>(pixel >> 8);
            out[2] = static_cast<std::uint8_t>(pixel);
            out[3] = static_cast<std::uint8_t>(pixel >> 24);
        }
    }
}

/// Empty: drawn.
std::string draw(const std::string& document, const SvgRequest& request, int memory) {
    GError* error = nullptr;
    const Owned<RsvgHandle> handle(
        rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(document.data()), document.size(), &error));
    if (handle == nullptr) return text_of(error);
    rsvg_handle_set_dpi(handle.get(), 96);
    const Owned<cairo_surface_t> surface(cairo_image_surface_create(
        CAIRO_FORMAT_ARGB32, static_cast<int>(request.width), static_cast<int>(request.height)));
    const Owned<cairo_t> context(cairo_create(surface.get()));
    const RsvgRectangle viewport{0, 0, static_cast<double>(request.width), static_cast<double>(request.height)};
    if (!rsvg_handle_render_document(handle.get(), context.get(), &viewport, &error)) return text_of(error);
    cairo_surface_flush(surface.get());
    if (cairo_status(context.get()) != CAIRO_STATUS_SUCCESS) return cairo_status_to_string(cairo_status(context.get()));

    const std::size_t size = std::size_t{4} * request.width * request.height;
    const Mapping out(memory, size, true);
    if (out.bytes().empty()) return "the memory of its picture cannot be reached";
    write_pixels(surface.get(), request, reinterpret_cast<std::uint8_t*>(out.bytes().data()));
    return {};
}

/// Where fonts lie, once they are listed: caches of them are written here, while that can be.
std::vector<std::string> folders_of_fonts() {
    std::vector<std::string> out;
    FcInit();
    FcStrList* const folders = FcConfigGetFontDirs(nullptr);
    while (const FcChar8* const folder = folders == nullptr ? nullptr : FcStrListNext(folders))
        out.emplace_back(reinterpret_cast<const char*>(folder));
    if (folders != nullptr) FcStrListDone(folders);
    return out;
}

void serve() {
    SvgRequest request;
    for (;;) {
        std::vector<Descriptor> memory;
        if (!receive_all(socket_of_program, &request, sizeof request, &memory) || memory.size() != 1) return;
        std::string document(request.document_size, '\0');
        if (!receive_all(socket_of_program, document.data(), document.size())) return;
        alarm(request.max_seconds);
        const std::string error = draw(document, request, memory[0].number());
        alarm(0);
        const SvgReply reply{.error_size = static_cast<std::uint32_t>(error.size())};
        if (!send_all(socket_of_program, &reply, sizeof reply) ||
            !send_all(socket_of_program, error.data(), error.size()))
            return;
    }
}

}  // namespace
}  // namespace darkroom

int main(int count, char** arguments) {
    const std::string error = darkroom::why_not_confined(darkroom::confine(darkroom::folders_of_fonts()),
                                                         {arguments + 1, static_cast<std::size_t>(count - 1)});
    if (darkroom::greet(error) && error.empty()) darkroom::serve();
    _exit(0);  // libraries have nothing to write at the end, and could not
}
