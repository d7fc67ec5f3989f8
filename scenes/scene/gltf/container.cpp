// SPDX-License-Identifier: MIT
#include "scene/gltf/container.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <optional>

#include "core/files.hpp"
#include "core/lies_in.hpp"
#include "image/codec/decoder.hpp"

namespace darkroom::scene::gltf {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t header_size = 12;
constexpr std::size_t chunk_header_size = 8;
constexpr std::uint32_t json_chunk = 0x4E4F534A;
constexpr std::uint32_t binary_chunk = 0x004E4942;

// Readers of JSON and of its extensions recurse; real files nest about ten deep.
constexpr int max_nesting = 64;

std::uint32_t little_endian(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i > 0; --i) value = value << 8 | std::to_integer<std::uint32_t>(bytes[offset + i - 1]);
    return value;
}

// What a value takes in the tree, in the text made from it for the library, and in the library's own tree.
constexpr std::uint64_t bytes_per_value = 256;

/// Told from the text, before anything is made of it.
struct JsonShape {
    std::uint64_t values = 1;
    bool is_too_deep = false;
};

JsonShape shape_of(std::string_view text) {
    JsonShape shape;
    int depth = 0;
    bool is_in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (is_in_string) {
            if (c == '\\') ++i;
            if (c == '"') is_in_string = false;
            continue;
        }
        if (c == '"') is_in_string = true;
        if (c == '{' || c == '[') ++depth;
        if (c == '}' || c == ']') --depth;
        if (c == '{' || c == '[' || c == ',') ++shape.values;
        shape.is_too_deep = shape.is_too_deep || depth > max_nesting;
    }
    return shape;
}

Result<nlohmann::json> parse_json(std::span<const std::byte> bytes, Budget& budget) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const JsonShape shape = shape_of(text);
    if (shape.is_too_deep) return user_error(fmt::format("JSON nested deeper than {} levels", max_nesting));
    DARKROOM_TRY(budget.take("the JSON", "values", shape.values, bytes_per_value));
    try {
        auto json = nlohmann::json::parse(text);
        if (!json.is_object()) return user_error("the JSON is not an object");
        return json;
    } catch (const std::exception& error) {
        // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
        std::string_view what = error.what();
        if (const std::size_t end = what.find("] "); end != std::string_view::npos) what.remove_prefix(end + 2);
        return user_error(fmt::format("is not JSON: {}", what));
    }
}

Result<Container> split_binary(std::span<const std::byte> file, Budget& budget) {
    if (file.size() < header_size)
        return user_error(fmt::format("GLB header cut off: {} bytes, {} are needed", file.size(), header_size));
    Container container;
    if (const auto version = little_endian(file, 4); version != 2)
        return user_error(fmt::format("GLB version {}, 2 is read here", version));
    const std::size_t length = little_endian(file, 8);
    if (length > file.size())
        return user_error(fmt::format("GLB truncated: the header says {} bytes, the file has {}", length, file.size()));
    if (length < file.size())
        container.warnings.push_back(fmt::format("{} bytes after the end of the GLB", file.size() - length));
    if (length < header_size + chunk_header_size)
        return user_error(fmt::format("GLB length {}: no room for a chunk", length));

    std::optional<std::span<const std::byte>> json;
    std::size_t position = header_size;
    for (int index = 0; position < length; ++index) {
        if (length - position < chunk_header_size)
            return user_error(fmt::format("GLB chunk {}: the header is cut off", index));
        const std::size_t size = little_endian(file, position);
        const std::uint32_t type = little_endian(file, position + 4);
        position += chunk_header_size;
        if (size > length - position)
            return user_error(fmt::format("GLB chunk {}: {} bytes, {} are left", index, size, length - position));
        const auto content = file.subspan(position, size);
        position += size;
        if (size % 4 != 0) {
            if (index == 0 || position < length)
                return user_error(fmt::format("GLB chunk {}: {} bytes is not a multiple of 4", index, size));
            container.warnings.push_back(fmt::format("GLB chunk {}: {} bytes is not a multiple of 4", index, size));
        }
        if ((index == 0) != (type == json_chunk))
            return user_error(fmt::format("GLB chunk {}: the first chunk, and no other, must be JSON", index));
        if (type == json_chunk) {
            if (size == 0) return user_error("GLB chunk 0: the JSON is empty");
            json = content;
        } else if (type == binary_chunk) {
            if (container.has_binary) return user_error(fmt::format("GLB chunk {}: a second BIN chunk", index));
            if (index != 1) container.warnings.push_back(fmt::format("GLB chunk {}: BIN is not the second", index));
            if (size == 0) container.warnings.push_back(fmt::format("GLB chunk {}: empty", index));
            container.binary = content;
            container.has_binary = true;
        }
    }
    DARKROOM_TRY_VALUE(container.json, parse_json(*json, budget));
    return container;
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

// RFC 3986, 2.1. A percent sign without two digits stands for itself, as file names in the wild have them.
std::string percent_decoded(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const int high = text[i] == '%' && i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
        const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
        if (low < 0) {
            out += text[i];
            continue;
        }
        out += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return out;
}

bool has_scheme(std::string_view uri) {
    const std::size_t colon = uri.find(':');
    return colon != std::string_view::npos && uri.substr(0, colon).find('/') == std::string_view::npos;
}

}  // namespace

Result<Container> split_container(std::span<const std::byte> file, Budget& budget) {
    if (file.empty()) return user_error("is empty");
    const std::string_view start(reinterpret_cast<const char*>(file.data()), std::min<std::size_t>(file.size(), 4));
    if (start == "glTF") return split_binary(file, budget);
    DARKROOM_TRY_VALUE(auto json, parse_json(file, budget));
    Container container;
    container.json = std::move(json);
    if (start.starts_with("\xef\xbb\xbf")) container.warnings.emplace_back("starts with a byte order mark");
    return container;
}

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

Result<fs::path> resolve_uri(const fs::path& folder, std::string_view uri, NamedFiles named_files) {
    const std::string shown = one_printable_line(uri.substr(0, 200));
    const auto leaves = [&] { return user_error(fmt::format("{}: leaves the folder of the model", shown)); };
    if (uri.empty()) return user_error("an empty URI");
    if (has_scheme(uri)) return user_error(fmt::format("{}: only files beside the model are read", shown));
    std::string name = percent_decoded(uri);
    if (std::any_of(name.begin(), name.end(), [](char c) { return c >= 0 && c < ' '; }))
        return user_error(fmt::format("{}: a control character in a file name", shown));
    // A backslash separates folders on the system where some files were made; it must not hide a way out here.
    std::string slashes = name;
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    const fs::path relative = fs::path(slashes).lexically_normal();
    const bool is_own = named_files == NamedFiles::Own;
    if (is_own && (slashes.front() == '/' || relative.is_absolute() || *relative.begin() == "..")) return leaves();

    std::error_code error;
    fs::path file = folder / fs::path(name);
    if (!fs::exists(file, error)) file = folder / relative;
    if (!fs::exists(file, error)) return user_error(fmt::format("{}: not found", shown));
    if (is_own && !lies_in(folder, file)) return leaves();
    // One file under several names is held once.
    const fs::path target = fs::canonical(file, error);
    if (error) return user_error(fmt::format("{}: {}", shown, error.message()));
    return target;
}

Result<std::vector<std::byte>> decode_data_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) return user_error("a data URI without data");
    const std::string_view header = uri.substr(0, comma);
    if (header.find(";;") != std::string_view::npos) return user_error("a data URI with an empty parameter");
    uri.remove_prefix(comma + 1);
    const std::string unescaped = percent_decoded(uri);
    if (!header.ends_with(";base64")) {
        const auto bytes = std::as_bytes(std::span(unescaped));
        return std::vector<std::byte>(bytes.begin(), bytes.end());
    }
    uri = unescaped;
    while (!uri.empty() && uri.back() == '=') uri.remove_suffix(1);
    static const auto digits = [] {
        std::array<std::uint8_t, 256> table{};
        table.fill(255);
        constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        for (std::size_t i = 0; i < letters.size(); ++i)
            table[static_cast<unsigned char>(letters[i])] = static_cast<std::uint8_t>(i);
        return table;
    }();
    std::vector<std::byte> bytes;
    bytes.reserve(uri.size() / 4 * 3 + 3);
    std::uint32_t group = 0;
    std::size_t count = 0;
    for (const char c : uri) {
        const std::uint32_t digit = digits[static_cast<unsigned char>(c)];
        if (digit == 255) return user_error("a data URI with a character outside base64");
        group = group << 6 | digit;
        if (++count % 4 == 0)
            for (const int shift : {16, 8, 0}) bytes.push_back(static_cast<std::byte>(group >> shift & 0xff));
    }
    if (count % 4 == 1) return user_error("a data URI that is cut off");
    if (count % 4 >= 2) bytes.push_back(static_cast<std::byte>(group >> (count % 4 == 2 ? 4 : 10) & 0xff));
    if (count % 4 == 3) bytes.push_back(static_cast<std::byte>(group >> 2 & 0xff));
    return bytes;
}

Result<std::vector<std::byte>> read_bounded(const fs::path& path, std::size_t most, bool must_fit) {
    return read_file(path, {.max_size = most, .takes_start = !must_fit, .is_path_in_errors = false});
}

}  // namespace darkroom::scene::gltf
