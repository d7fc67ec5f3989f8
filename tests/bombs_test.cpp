// SPDX-License-Identifier: MIT
// Small files that ask for much. The program runs as a child under limits of memory and time, and what it took is held
// against what the same command takes for a file of one pixel, or of one triangle.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "formats/png/png_write.hpp"
#include "image/picture/write.hpp"
#include "image/test_bytes.hpp"
#include "scene/gltf/test_model.hpp"
#include "tests/cli/cli_support.hpp"

namespace darkroom::test {
namespace {

using nlohmann::json;

// A sanitizer's shadow memory needs all of the address space, and says nothing of how much is used; its code takes
// several times as long.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool is_memory_known = false;
constexpr double more_seconds = 10;
#else
constexpr bool is_memory_known = true;
constexpr double more_seconds = 2;
#endif

struct Cost {
    int code = -1;
    std::string err;
    long mebibytes = 0;
    double seconds = 0;  ///< of the CPU, which other work on the machine does not add to
};

double seconds_of(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

class CliBombs : public CliFixture {
  protected:
    [[nodiscard]] Cost cost(std::vector<std::string> arguments) const {
        const std::string err = path("") + "err.txt";
        arguments.insert(arguments.begin(), program);
        std::vector<char*> raw;
        for (std::string& argument : arguments) raw.push_back(argument.data());
        raw.push_back(nullptr);
        const pid_t child = ::fork();
        if (child == 0) {
            const rlimit memory{rlim_t{4} << 30, rlim_t{4} << 30}, time{60, 60};
            if (is_memory_known) ::setrlimit(RLIMIT_AS, &memory);
            ::setrlimit(RLIMIT_CPU, &time);
            ::dup2(::open("/dev/null", O_WRONLY), 1);
            ::dup2(::open(err.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), 2);
            ::execv(program.c_str(), raw.data());
            ::_exit(127);
        }
        int status = 0;
        rusage usage{};
        EXPECT_EQ(::wait4(child, &status, 0, &usage), child);
        Cost out{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), content(err), usage.ru_maxrss / 1024,
                 seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime)};
        std::filesystem::remove(err);
        return out;
    }
    [[nodiscard]] std::vector<std::string> command(const std::string& file) const {
        const bool is_scene = file.ends_with("gltf") || file.ends_with("toml");
        std::vector<std::string> out{is_scene ? "render" : "develop", path(file), "-o", path("out.png")};
        if (is_scene) out.insert(out.end(), {"--width", "1", "--height", "1"});
        return out;
    }
    void expect_refused_cheaply(const std::string& file, const std::string& part, const Cost& usual) const {
        const Cost bomb = cost(command(file));
        EXPECT_EQ(bomb.code, 1) << file << ": " << bomb.err;
        EXPECT_EQ(std::count(bomb.err.begin(), bomb.err.end(), '\n'), 1) << file << ": " << bomb.err;
        EXPECT_NE(bomb.err.find(part), std::string::npos) << file << ": " << bomb.err;
        EXPECT_LE(bomb.seconds, usual.seconds + more_seconds) << file;
        if (is_memory_known) {
            EXPECT_LE(bomb.mebibytes, usual.mebibytes + 256) << file;
        }
        EXPECT_FALSE(std::filesystem::exists(path("out.png"))) << file;
    }
    void expect_cheap(const std::string& file, const Cost& usual) const {
        const Cost cheap = cost(command(file));
        EXPECT_EQ(cheap.code, 0) << file << ": " << cheap.err;
        EXPECT_LE(cheap.seconds, usual.seconds + more_seconds) << file;
        if (is_memory_known) {
            EXPECT_LE(cheap.mebibytes, usual.mebibytes + 256) << file;
        }
        std::filesystem::remove(path("out.png"));
    }
    /// What the command takes for a file that asks for nothing.
    [[nodiscard]] Cost usual(const std::string& file) const {
        const Cost out = cost(command(file));
        EXPECT_EQ(out.code, 0) << out.err;
        std::filesystem::remove(path("out.png"));
        return out;
    }
};

json repeat(const json& element, std::size_t count) { return std::vector<json>(count, element); }

/// A triangle, and ways to make it a bomb. The data of all else are zeros that lie nowhere.
struct Bomb : scene::TestModel {
    Bomb() {
        add_triangle();
        static_cast<void>(text());
    }
    std::size_t zeros(std::size_t count, const char* type, int component = 5126) {
        json["accessors"].push_back({{"componentType", component}, {"count", count}, {"type", type}});
        return json["accessors"].size() - 1;
    }
    nlohmann::json& primitive() { return json["meshes"][0]["primitives"][0]; }
};

TEST_F(CliBombs, Models) {
    write("one.gltf", Bomb().text());
    const Cost usual = this->usual("one.gltf");
    const auto expect = [&](const std::string& name, const std::string& part, const auto& damage) {
        Bomb bomb;
        damage(bomb);
        write(name + ".gltf", bomb.text());
        expect_refused_cheaply(name + ".gltf", part, usual);
    };
    const json empty = json::object();
    expect("values", "the JSON: ", [](Bomb& b) { b.json["extras"] = repeat(0, 3'000'000); });
    expect("nodes", "/nodes: 200001 elements", [&](Bomb& b) {
        for (int i = 0; i < 200'000; ++i) b.json["nodes"].push_back(empty);
    });
    expect("materials", "/materials: ", [&](Bomb& b) { b.json["materials"] = repeat(empty, 160'000); });
    expect("textures", "/textures: ", [&](Bomb& b) { b.json["textures"] = repeat(empty, 160'000); });
    expect("instances", "9000000 instances", [](Bomb& b) {
        b.json["meshes"][0]["primitives"] = repeat(b.primitive(), 3000);
        b.json["nodes"] = repeat(b.json["nodes"][0], 3000);
    });
    const auto skinned = [](Bomb& b, std::size_t vertices, std::size_t joints, std::size_t nodes) {
        b.primitive()["attributes"] = {{"POSITION", b.zeros(vertices, "VEC3")},
                                       {"NORMAL", b.zeros(vertices, "VEC3")},
                                       {"JOINTS_0", b.zeros(vertices, "VEC4", 5121)},
                                       {"WEIGHTS_0", b.zeros(vertices, "VEC4")}};
        std::vector<std::size_t> list(joints);
        for (std::size_t i = 0; i < joints; ++i) list[i] = i;
        b.json["skins"] = {{{"joints", list}}};
        b.json["nodes"] = repeat({{"mesh", 0}, {"skin", 0}}, nodes);
    };
    expect("joints", "16000000 joints", [&](Bomb& b) { skinned(b, 3, 4000, 4000); });
    expect("skinned", "vertices of skins", [&](Bomb& b) {
        skinned(b, 90'000, 1, 5000);
        // Drawn by a corner each, so that they are not dropped.
        b.primitive()["mode"] = 5;
    });
    expect("weights", "100000000 weights", [&](Bomb& b) {
        b.primitive()["targets"] = repeat(empty, 20'000);
        b.json["nodes"] = repeat(b.json["nodes"][0], 5000);
    });
    expect("targets", "vertices of morph targets of 24 bytes", [&](Bomb& b) {
        const std::size_t positions = b.zeros(60'000, "VEC3");
        b.primitive() = {{"attributes", {{"POSITION", positions}}},
                         {"targets", repeat({{"POSITION", positions}}, 2000)}};
    });
    expect("keys", "numbers of 4 bytes", [](Bomb& b) {
        std::vector<float> times(50'000);
        for (std::size_t i = 0; i < times.size(); ++i) times[i] = static_cast<float>(i);
        b.json.erase("buffers");
        const std::size_t input = b.accessor(times, "SCALAR"), output = b.zeros(times.size(), "VEC3");
        b.json["animations"] = repeat({{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}},
                                       {"samplers", {{{"input", input}, {"output", output}}}}},
                                      3000);
    });
    expect("nothing", "nothing is drawn", [](Bomb& b) { b.json["nodes"] = {json::object()}; });
}

// What is named many times is no fault: it is held once, and the model is drawn.
TEST_F(CliBombs, BuffersThatAreOneCostOne) {
    write("one.gltf", Bomb().text());
    const Cost usual = this->usual("one.gltf");
    const auto expect = [&](const std::string& name, const json& buffer, std::size_t count) {
        Bomb bomb;
        for (std::size_t i = 0; i < count; ++i) bomb.json["buffers"].push_back(buffer);
        write(name, bomb.text());
        this->expect_cheap(name, usual);
    };
    expect("nowhere.gltf", {{"byteLength", 1 << 20}}, 20'000);
    write("data.bin", std::string(1 << 20, '\0'));
    expect("same_file.gltf", {{"byteLength", 1 << 20}, {"uri", "data.bin"}}, 4000);
}

TEST_F(CliBombs, Scenes) {
    write("one.toml", "[entities.a.bounds]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n");
    const Cost usual = this->usual("one.toml");
    const auto repeated = [](const std::string& before, const std::string& after, int count) {
        std::string out;
        for (int i = 0; i < count; ++i) out += before + std::to_string(i) + after;
        return out;
    };
    Bomb model;
    model.json["meshes"][0]["primitives"] = repeat(model.primitive(), 300);
    write("model.gltf", model.text());
    write("models.toml", repeated("[entities.e", ".model]\nasset = \"model.gltf\"\n", 3000));
    expect_refused_cheaply("models.toml", "instances of", usual);
    write("emitters.toml", repeated("[entities.e", ".particle_emitter]\nmax_particles = 10000\n", 3000));
    expect_refused_cheaply("emitters.toml", "particles of", usual);
    write("idle.toml", repeated("[entities.e", ".particle_emitter]\nmax_particles = 1\n", 3000));
    expect_refused_cheaply("idle.toml", "emitters of", usual);

    std::string nested = "[templates.t0.entities.e.bounds]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n";
    for (int depth = 1; depth < 8; ++depth)
        for (int i = 0; i < 10; ++i)
            nested += "[templates.t" + std::to_string(depth) + ".prefabs.p" + std::to_string(i) + "]\ntemplate = \"t" +
                      std::to_string(depth - 1) + "\"\n";
    write("nested.toml", nested + "[prefabs.a]\ntemplate = \"t7\"\n");
    expect_refused_cheaply("nested.toml", "more than 10000 prefabs", usual);
    write("itself.toml", "[templates.t.prefabs.p]\ntemplate = \"t\"\n[prefabs.a]\ntemplate = \"t\"\n");
    expect_refused_cheaply("itself.toml", "hold themselves", usual);
    write("deep.toml", "a = " + std::string(100'000, '['));
    expect_refused_cheaply("deep.toml", "maximum nested value depth of 16", usual);
    std::string key = "k";
    for (int i = 0; i < 60; ++i) key += ".a";
    write("tables.toml", repeated("a", key + " = 1\n", 20'000));
    expect_refused_cheaply("tables.toml", "more than 262144 dots in keys", usual);
    write("long.toml", std::string((4 << 20) + 1, '\n'));
    expect_refused_cheaply("long.toml", "4194305 bytes", usual);
}

// What is behind a surface, or where it is, is not shaded: such boxes took 48 s where they were.
TEST_F(CliBombs, AThousandBoxesInOnePlaceAreShadedOnce) {
    std::string boxes = "[camera]\nposition = [0, 1, 4]\n";
    const auto draw = [&](const std::string& name) {
        write(name + ".scene.toml", boxes);
        return cost({"render", path(name + ".scene.toml"), "--size", "128x72", "-o", path(name + ".png")});
    };
    const auto add = [&](int i, const std::string& color) {
        boxes += fmt::format(
            "[entities.b{}]\nbounds = {{ min = [-1, -1, -1], max = [1, 1, 1] }}\nmaterial = {{ color = {} }}\n", i,
            color);
    };
    add(1000, "[0.1, 0.2, 0.9]");
    const Cost one = draw("one");
    boxes.resize(boxes.find("[entities"));
    for (int i = 0; i < 1000; ++i) add(i, "[0.9, 0.1, 0.1]");
    add(1000, "[0.1, 0.2, 0.9]");
    const Cost thousand = draw("thousand");
    ASSERT_EQ(one.code + thousand.code, 0) << one.err << thousand.err;
    EXPECT_LE(thousand.seconds, one.seconds + more_seconds);
    EXPECT_EQ(content(path("one.png")), content(path("thousand.png"))) << "the last one is seen";
}

TEST_F(CliBombs, Pictures) {
    ASSERT_TRUE(write_picture(path("one.exr"), Picture(1, 1)));
    const Cost usual = this->usual("one.exr");
    const auto number = [](std::int32_t value) { return std::string(reinterpret_cast<const char*>(&value), 4); };
    const auto exr = [&](std::int32_t width, std::int32_t height, std::int32_t tile) {
        const auto attribute = [&](const std::string& name, const std::string& type, const std::string& value) {
            return name + '\0' + type + '\0' + number(static_cast<std::int32_t>(value.size())) + value;
        };
        std::string channels;
        for (const char name : {'A', 'B', 'G', 'R'})
            channels += std::string(1, name) + '\0' + number(2) + number(0) + number(1) + number(1);
        const std::string window = number(0) + number(0) + number(width - 1) + number(height - 1);
        std::string out =
            number(0x01312f76) + number(tile > 0 ? 0x202 : 2) + attribute("channels", "chlist", channels + '\0') +
            attribute("compression", "compression", std::string(1, '\3')) + attribute("dataWindow", "box2i", window) +
            attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
            attribute("pixelAspectRatio", "float", std::string("\0\0\x80\x3f", 4)) +
            attribute("screenWindowCenter", "v2f", std::string(8, '\0')) +
            attribute("screenWindowWidth", "float", std::string("\0\0\x80\x3f", 4));
        if (tile > 0) out += attribute("tiles", "tiledesc", number(tile) + number(tile) + std::string(1, '\0'));
        out += '\0';
        out.resize(2 << 20);
        return out;
    };
    write("lines.exr", exr(10'000, 12'000, 0));
    expect_refused_cheaply("lines.exr", "its pixels need 1920000000 bytes", usual);
    write("tile.exr", exr(8192, 8192, 8192));
    expect_refused_cheaply("tile.exr", "chunks of 8192x8192 pixels", usual);
    write("jpeg.jpg", std::string("\xff\xd8\xff\xc0\0\x11\x08\xfd\xe8\xfd\xe8\x03", 12) + std::string(2 << 20, '\0'));
    expect_refused_cheaply("jpeg.jpg", "its pixels need 12675000000 bytes", usual);
    write("png.png",
          std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x40\0\0\0\x40\0\x10\x06\0\0\0\xf9\x58\xcc\xc7", 33) +
              std::string(2 << 20, '\0'));
    expect_refused_cheaply("png.png", "its pixels need 2147483648 bytes", usual);
}

// What a file lists is gone over as often as it is long, not as often as it is long times its length.
TEST_F(CliBombs, LayersOfManyParts) {
    write("few.exr", exr_of_layers(1, 1));
    write("some.exr", exr_of_layers(16, 1024));
    write("many.exr", exr_of_layers(64, 1024));
    const auto info = [&](const std::string& file) { return cost({"info", path(file)}); };
    const Cost few = info("few.exr"), some = info("some.exr"), many = info("many.exr");
    EXPECT_EQ(many.code, 0) << many.err;
    // Four times as many in four times the time, and not in sixteen times; what is left is noise.
    EXPECT_LE(many.seconds, 8 * some.seconds + 2);
    if (is_memory_known) {
        EXPECT_LE(many.mebibytes, few.mebibytes + 256) << "of which 1024 are listed";
    }
    expect_refused_cheaply("many.exr", "has no color", few);
}

// Of what inflates, or is gone over, again and again.
TEST_F(CliBombs, PicturesThatAreMuchWork) {
    ASSERT_TRUE(write_picture(path("one.png"), Picture(1, 1)));
    const Cost usual = this->usual("one.png");
    const std::vector<std::uint8_t> letters(std::size_t{1620} * 1620 * 3, 'A');
    const auto packed = encode_png({.width = 1620, .height = 1620, .compression = "9", .samples = letters.data()});
    ASSERT_TRUE(packed);
    const std::string file(reinterpret_cast<const char*>(packed->data()), packed->size());
    const std::size_t start = file.find("IDAT") + 4;
    const std::string stream = file.substr(start, file.rfind("IEND") - 8 - start);  // of 7.9 MB
    const auto png = [&](const std::string& between) {
        return png_start + png_header(1, 1, 8, 2) + between + png_chunk("IDAT", stored(std::string("\0\1\2\3", 4))) +
               png_chunk("IEND", "");
    };
    std::string texts;
    for (int i = 0; i < 400; ++i) texts += png_chunk("zTXt", "k" + std::to_string(i) + '\0' + '\0' + stream);
    write("texts.png", png(texts));
    expect_cheap("texts.png", usual);
    write("profile.png", png(png_chunk("iCCP", std::string("name\0\0", 6) + stream)));
    expect_refused_cheaply("profile.png", "the profile of its colors has more than 4194304 bytes", usual);

    Bomb model;
    model.json["images"] = {{{"uri", "texts.png"}}};
    model.json["textures"] = {{{"source", 0}}};
    model.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    model.primitive()["material"] = 0;
    write("one.gltf", Bomb().text());
    write("texts.gltf", model.text());
    expect_cheap("texts.gltf", this->usual("one.gltf"));

    // Scans of all blocks by runs of 32767 that hold nothing (ITU-T T.81, annex G): 100 bytes each.
    const auto segment = [](char code, const std::string& data) {
        return std::string("\xff") + code + big_endian(static_cast<std::uint32_t>(data.size() + 2), 2) + data;
    };
    const std::string zeros(15, '\0');
    std::string jpeg = "\xff\xd8" + segment('\xdb', '\0' + std::string(64, '\1')) +
                       segment('\xc2', '\x08' + big_endian(8192, 2) + big_endian(8192, 2) + "\x01\x01\x11" + '\0') +
                       segment('\xc4', std::string("\0\1", 2) + zeros + '\0') +
                       segment('\xc4', std::string("\x10\1", 2) + zeros + '\xe0') +
                       segment('\xda', std::string("\1\1\0\0\0\0", 6)) + std::string(131072, '\0');
    for (int i = 0; i < 1000; ++i) jpeg += segment('\xda', std::string("\1\1\0\1\x3f\0", 6)) + std::string(91, '\0');
    write("scans.jpg", jpeg + "\xff\xd9");
    expect_refused_cheaply("scans.jpg", "1001 scans", usual);

    TestTiff tile = TestTiff::gray(16, 16);
    tile.tags.erase(273), tile.tags.erase(278), tile.tags.erase(279);
    tile.tags[259] = {8}, tile.tags[322] = {65536}, tile.tags[323] = {32768};
    tile.tags[324] = {TestTiff::samples_here}, tile.tags[325] = {static_cast<std::uint32_t>(stream.size())};
    tile.samples = stream;
    write("tile.tif", tile.text());
    expect_refused_cheaply("tile.tif", "tiles of 65536x32768", usual);
}

}  // namespace
}  // namespace darkroom::test
