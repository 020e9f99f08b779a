// Too little memory, in steps from none to enough: whatever it suffices for is done, and what it does not suffice for
// ends with one line and the documented exit code.
#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/Gzip.h"
#include "tests/program/Program.h"
#include "tests/unit/GltfBuilder.h"

#if !defined(_WIN32) && !defined(__APPLE__) && !defined(RT_SANITIZED) // sanitizers reserve terabytes

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class Memory : public ProgramTest {
  protected:
    // KiB with which the program can be loaded.
    std::uint64_t minToStart() {
        addressSpace_ = 20'000;
        while (addressSpace_ < 500'000 && cpu({"--version"}).exitCode != 0) addressSpace_ += 5'000;
        return addressSpace_;
    }
};

// Once there is a film, its samples are written, whatever else cannot be made.
TEST_F(Memory, NothingOfARenderThatFitsIsLost) {
    const Arguments arguments = {"-q",       "--no-config", "--threads",    "1",     "--width", "900",
                                 "--height", "900",         "--spp",        "1",     "--scene", "next-week-two-spheres",
                                 "-o",       "a.png",       "-o",           "a.exr", "--aov",   "albedo,depth,samples",
                                 "--stats",  "s.json",      "--checkpoint", "c.rtc"};
    const char* const always[] = {"a.png", "a.exr", "a.samples.png", "a.samples.exr", "s.json", "c.rtc"};
    bool filmWasTooLarge = false, somethingFailed = false, isEnough = false;
    const std::uint64_t first = minToStart();
    for (addressSpace_ = first; addressSpace_ <= first + 200'000 && !isEnough; addressSpace_ += 4'000) {
        const Outcome outcome = cpu(arguments);
        isEnough = outcome.exitCode == 0;
        if (!isEnough) {
            EXPECT_TRUE(failsWith(outcome, 1, "memory")) << addressSpace_;
            const bool isOfFilm = outcome.err.find("not enough memory for an image") != std::string::npos;
            filmWasTooLarge = filmWasTooLarge || isOfFilm;
            if (isOfFilm || !filmWasTooLarge) continue;
            somethingFailed = true;
        }
        for (const char* file : always) EXPECT_TRUE(fs::remove(path(file))) << addressSpace_ << " KiB: " << file;
    }
    EXPECT_TRUE(filmWasTooLarge && somethingFailed && isEnough);
}

// Of 300 000 spheres: reading, compiling and building all run out somewhere, on one thread and on several.
TEST_F(Memory, ASceneThatDoesNotFit) {
    const std::uint64_t first = minToStart();
    for (const char* threads : {"1", "2", "16"}) {
        for (addressSpace_ = first; addressSpace_ <= first + 90'000; addressSpace_ += 6'000) {
            const Outcome outcome = cpu({"-q", "--no-config", "--threads", threads, "--width", "16", "--height", "16",
                                         "--spp", "1", "--scene", "white-spheres:300000", "-o", "a.pfm"});
            EXPECT_TRUE(outcome.exitCode == 0 ? outcome.err.empty() : bool(failsWith(outcome, 1, "memory")))
                << threads << " threads, " << addressSpace_ << " KiB: " << outcome.exitCode << " " << outcome.err;
        }
    }
}

// The same as a file of 10 MB, whose JSON values allocate where they end.
TEST_F(Memory, ASceneFileThatDoesNotFit) {
    ASSERT_EQ(cpu({"--scene", "white-spheres:150000", "--export-scene", "big.json"}).exitCode, 0);
    int refused = 0;
    const std::uint64_t first = minToStart();
    for (addressSpace_ = first; addressSpace_ <= first + 54'000; addressSpace_ += 6'000) {
        const Outcome outcome = cpu({"-q", "--no-config", "--threads", "1", "--width", "16", "--height", "16", "--spp",
                                     "1", "--scene", "big.json", "-o", "a.pfm"});
        refused += outcome.exitCode != 0;
        const int expected = outcome.exitCode == 3 ? 3 : 1; // the file's text does not fit
        EXPECT_TRUE(outcome.exitCode == 0 ? outcome.err.empty() : bool(failsWith(outcome, expected, "memory")))
            << addressSpace_ << " KiB: " << outcome.exitCode << " " << outcome.err;
    }
    EXPECT_GT(refused, 3);
}

#if defined(RT_FAULT_ALLOCATIONS)

class MeshMemory : public Memory {
  protected:
    static constexpr std::size_t kSide = 500; // vertices of a mesh, by as many

    // A scene of so many bumpy squares; of none: a triangle.
    void save(const std::string& name, std::size_t squares) const {
        scene::GltfBuilder file;
        for (std::size_t n = 0; n < squares; ++n) file.addNode({{"mesh", file.addMesh(square(n, file))}});
        if (squares == 0) file.addNode({{"mesh", file.addMesh(file.triangle())}});
        file.save(path(name));
    }
    // The bytes that are allocated together at most while a scene is read, compiled and rendered.
    std::size_t peakOf(const std::string& scene) const {
        const Outcome outcome = cpu({"-q", "--no-config", "--threads", "2", "--width", "8", "--height", "8", "--spp",
                                     "1", "--scene", scene, "-o", "a.pfm", "--stats", "s.json"},
                                    {{"LD_PRELOAD", RT_FAULT_ALLOCATIONS}, {"RT_ALLOCATION_COUNT", path("count")}});
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        std::istringstream counts(bytesOf("count"));
        std::size_t number = 0, peak = 0;
        counts >> number >> peak;
        return peak;
    }
    // What kernels read of the scene that was rendered last: arrays of the compiled scene, and the engine's.
    std::size_t kernelBytes(std::size_t vertices, std::size_t triangles) const {
        constexpr std::size_t kVertex = (3 + 3 + 2) * sizeof(float), kTriangle = (3 + 1) * sizeof(std::uint32_t);
        const std::size_t engine = jsonOf("s.json")["memory"]["device_bytes"];
        return vertices * kVertex + triangles * kTriangle + engine;
    }

    struct Square {
        std::vector<float> positions, normals, uvs;
        std::vector<std::uint32_t> corners;
    };
    static Square bumpySquare(std::size_t number, std::size_t side) {
        Square made;
        const auto last = static_cast<float>(side - 1);
        for (std::size_t i = 0; i < side * side; ++i) {
            const std::size_t column = i % side, row = i / side;
            const float x = static_cast<float>(column) / last, y = static_cast<float>(row) / last;
            const float z = 0.05f * std::sin(20 * x) * std::sin(30 * y);
            made.positions.insert(made.positions.end(), {x, y, z + static_cast<float>(number)});
            made.normals.insert(made.normals.end(), {0, 0, 1});
            made.uvs.insert(made.uvs.end(), {x, y});
            if (i % side == side - 1 || i / side == side - 1) continue;
            const auto a = static_cast<std::uint32_t>(i), b = a + static_cast<std::uint32_t>(side);
            made.corners.insert(made.corners.end(), {a, a + 1, b, b, a + 1, b + 1});
        }
        return made;
    }

  private:
    static nlohmann::json square(std::size_t number, scene::GltfBuilder& file) {
        const auto [positions, normals, uvs, corners] = bumpySquare(number, kSide);
        return {{"attributes",
                 {{"POSITION", file.addAccessor(positions, "VEC3")},
                  {"NORMAL", file.addAccessor(normals, "VEC3")},
                  {"TEXCOORD_0", file.addAccessor(uvs, "VEC2")}}},
                {"indices", file.addAccessor(corners, "SCALAR")}};
    }
};

// Of one mesh compiling takes most, of many building the tree does. A scene of a triangle stands for what everything
// else takes.
TEST_F(MeshMemory, IsLittleMoreThanWhatKernelsRead) {
    save("least.glb", 0);
    const std::size_t minimum = peakOf("least.glb");
    ASSERT_GT(minimum, 0u);
    for (const auto& [count, bound] : {std::pair{1, 1.3}, std::pair{4, 1.2}}) {
        const auto squares = static_cast<std::size_t>(count);
        save("scene.glb", squares);
        const auto peak = static_cast<double>(peakOf("scene.glb") - minimum);
        const std::size_t bytes = kernelBytes(squares * kSide * kSide, squares * 2 * (kSide - 1) * (kSide - 1));
        EXPECT_LT(peak, bound * static_cast<double>(bytes)) << squares;
    }
}

// As exporters of pbrt write meshes: no two triangles share a vertex, so that attributes are most of it.
class PbrtMeshMemory : public MeshMemory {
  protected:
    static constexpr std::size_t kTriangles = 2 * 199 * 199;

    PbrtMeshMemory() {
        const Square square = bumpySquare(0, 200);
        for (const std::uint32_t corner : square.corners) {
            const auto copy = [&](const std::vector<float>& from, std::size_t each, std::vector<float>& to) {
                const float* const values = from.data() + each * corner;
                to.insert(to.end(), values, values + each);
            };
            copy(square.positions, 3, positions_);
            copy(square.normals, 3, normals_);
            copy(square.uvs, 2, uvs_);
        }
    }
    std::string triangleMesh() const {
        std::ostringstream out;
        const auto add = [&out](const char* name, const std::vector<float>& values) {
            out << name << " [";
            for (const float value : values) out << value << ' ';
            out << "]\n";
        };
        add("Shape \"trianglemesh\" \"point3 P\"", positions_);
        add("\"normal N\"", normals_);
        add("\"point2 uv\"", uvs_);
        out << "\"integer indices\" [";
        for (std::size_t i = 0; i < 3 * kTriangles; ++i) out << i << ' ';
        out << "]\n";
        return out.str();
    }
    std::string ply(bool isBinary) const {
        std::ostringstream out;
        out << "ply\nformat " << (isBinary ? "binary_little_endian" : "ascii") << " 1.0\nelement vertex "
            << 3 * kTriangles;
        for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "u", "v"}) out << "\nproperty float " << name;
        out << "\nelement face " << kTriangles << "\nproperty list uchar int vertex_indices\nend_header\n";
        const auto add = [&](auto value, char end) {
            if (isBinary)
                out.write(reinterpret_cast<const char*>(&value), sizeof(value));
            else
                out << +value << end;
        };
        for (std::size_t i = 0; i < 3 * kTriangles; ++i) {
            for (std::size_t c = 0; c < 3; ++c) add(positions_[3 * i + c], ' ');
            for (std::size_t c = 0; c < 3; ++c) add(normals_[3 * i + c], ' ');
            for (std::size_t c = 0; c < 2; ++c) add(uvs_[2 * i + c], c == 1 ? '\n' : ' ');
        }
        for (std::uint32_t i = 0; i < kTriangles; ++i) {
            add(std::uint8_t{3}, ' ');
            for (std::uint32_t c = 0; c < 3; ++c) add(3 * i + c, c == 2 ? '\n' : ' ');
        }
        return out.str();
    }
    std::size_t peakOfShape(const std::string& shape) const {
        const std::string view = "LookAt .5 .5 2 .5 .5 0 0 1 0\nCamera \"perspective\"\nWorldBegin\n";
        write("scene.pbrt", view + "LightSource \"infinite\"\n" + shape);
        return peakOf("scene.pbrt");
    }
    void write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path(name), std::ios::binary) << bytes;
    }

  private:
    std::vector<float> positions_, normals_, uvs_;
};

TEST_F(PbrtMeshMemory, IsLittleMoreThanWhatKernelsRead) {
    const std::size_t minimum = peakOfShape(R"(Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0])");
    ASSERT_GT(minimum, 0u);
    const auto expectFew = [&](const char* what, const std::string& shape) {
        const auto peak = static_cast<double>(peakOfShape(shape) - minimum);
        EXPECT_LT(peak, 1.3 * static_cast<double>(kernelBytes(3 * kTriangles, kTriangles))) << what;
    };
    expectFew("trianglemesh", triangleMesh());
    write("binary.ply", ply(true));
    expectFew("binary", R"(Shape "plymesh" "string filename" "binary.ply")");
    write("text.ply", ply(false));
    expectFew("text", R"(Shape "plymesh" "string filename" "text.ply")");
#if defined(RT_HAS_ZLIB)
    write("packed.ply.gz", gzipOf(ply(true)));
    expectFew("packed", R"(Shape "plymesh" "string filename" "packed.ply.gz")");
#endif
}

#endif

} // namespace
} // namespace rt::test

#endif
