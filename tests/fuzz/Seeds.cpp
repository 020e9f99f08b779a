// rt-fuzz-seeds FOLDER: writes the inputs that fuzzing starts from, FOLDER/TARGET/*, by the writers of this project.
#include <iostream>
#include <random>
#include <sstream>
#include <string>

#include "Common/App/Interactive/GuiSettings.h"
#include "Common/App/Interactive/RunHistory.h"
#include "Common/Bench/Suite.h"
#include "Common/Image/Checkpoint.h"
#include "Common/Image/ImageIo.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/fuzz/Fuzz.h"

namespace {

namespace fs = std::filesystem;

class Seeds {
  public:
    explicit Seeds(fs::path folder) : folder_(std::move(folder)) {}

    fs::path place(const std::string& target, const std::string& name) const {
        fs::create_directories(folder_ / target);
        return folder_ / target / name;
    }
    void write(const std::string& target, const std::string& name, const std::string& bytes) const {
        std::ofstream(place(target, name), std::ios::binary) << bytes;
    }

  private:
    fs::path folder_;
};

void writeScenes(const Seeds& seeds) {
    constexpr std::size_t kSmall = 16 << 10; // bytes; mutations of what is longer are slow
    for (const auto& builtin : rt::scene::builtinScenes()) {
        const std::string text = rt::scene::toJson(rt::scene::findBuiltinScene(std::string(builtin.id)));
        if (text.size() <= kSmall) seeds.write("scene", std::string(builtin.id), text);
    }
}

void writeMeshes(const Seeds& seeds) {
    const std::string mesh = "mtllib f.mtl\nv 0 0 0\nv 1 0 0 1\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n"
                             "usemtl a\nf 1/1/1 2/2/1 3/3/1\nusemtl b\nf -4//1 -3//1 -2//1 -1//1\n";
    const std::string materials = "newmtl a\nKd .5 .5 .5\nmap_Kd -s 2 2 a.png\nillum 2\n"
                                  "newmtl b\nKs 1 1 1\nPr .1\nillum 3\nnewmtl c\nillum 4\nNi 1.5\nTf 1 1 1\n"
                                  "newmtl d\nKe 4 4 4\n";
    seeds.write("obj", "materials", mesh + '\0' + materials);
    seeds.write("obj", "plain", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
}

void writeImages(const Seeds& seeds) {
    rt::image::Image image(5, 4);
    std::minstd_rand random;
    for (float& value : image.data) value = static_cast<float>(random() % 1000) / 500;
    for (const std::string format : {"png", "hdr", "exr", "pfm"})
        rt::image::writeImage(seeds.place(format, "written." + format), rt::image::ImageRows(image),
                              "{\"scene\": \"a\"}");
    for (const auto& entry : fs::directory_iterator(fs::path(RT_TEST_DATA_DIR) / "images")) {
        const std::string format = entry.path().extension().string().substr(1);
        fs::copy_file(entry.path(), seeds.place(format, entry.path().filename().string()),
                      fs::copy_options::overwrite_existing);
    }
    // 1 x 1, 24 bits, uncompressed.
    const char bmp[] = "BM\x3a\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\1\0\0\0\1\0\0\0\1\0\x18\0\0\0\0\0\4\0\0\0\0\0\0\0\0\0"
                       "\0\0\0\0\0\0\0\0\0\0\x10\x80\xff";
    seeds.write("bmp", "one", std::string(bmp, sizeof bmp));
    const char tga[] = "\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x18\0\x10\x80\xff";
    seeds.write("tga", "one", std::string(tga, sizeof tga - 1));
}

void writeCheckpoints(const Seeds& seeds) {
    for (const bool adaptive : {false, true}) {
        rt::image::FilmDesc desc{.width = 9, .height = 3, .replicates = 2, .secondMoments = !adaptive};
        desc.adaptive = adaptive;
        rt::image::Film film(desc);
        film.reserveOpenBlocks();
        rt::image::Film::TileBlock block;
        film.begin(0, 0, block);
        block.count = 3;
        for (float& value : block.sum) value = 1;
        film.commit(0, 0, block);
        std::ostringstream out;
        rt::image::writeCheckpoint(out, {{"scene", "a"}}, film);
        seeds.write("checkpoint", adaptive ? "adaptive" : "plain", out.str());
    }
}

void writeTexts(const Seeds& seeds) {
    rt::app::RunRecord record;
    record.time = rt::app::utcNow();
    record.app = "ray-tracing-cpu";
    record.width = 600;
    record.samplesPerSecond = 1e6;
    record.curve = {{1, 0.5}, {2, 0.25}};
    const std::string line = rt::app::toJsonLine(record) + '\n';
    seeds.write("history", "two", line + line);

    rt::app::GuiSettings settings;
    settings.recent = {"a.json"};
    settings.openPanels = {{"scene", false}};
    rt::app::saveGuiSettings(seeds.place("settings", "settings"), settings);

    for (const rt::bench::NamedSuite& suite : rt::bench::namedSuites()) seeds.write("suite", suite.name, suite.text);

    seeds.write("flags", "render",
                "--scene\nwhite-spheres:9\n--width=64\n--aspect\n1.5\n--spp\n4\n-o\na.png\n--aov\nalbedo,depth\n"
                "--region\n1,2,3,4\n--sampler\nstratified\n--time-limit\n1e1\n--threads\n2");
    seeds.write("flags", "share",
                "--tiles=1/3\n--checkpoint\na.rtc\n--light-sampling\nmixture\n--features\nspheres,quads\n--seed=3\n"
                "--camera={\"look_from\": [0, 0, 1], \"look_at\": [0, 0, 0]}\n--russian-roulette=off");
    seeds.write("config", "lines", "# a\nspp = 5\nscene = \"a b\"\noutput = [\"a.png\", # b\n 'b.exr',\n]\naov=depth,albedo");
    seeds.write("config", "json", "{\"spp\": 5, \"output\": [\"a.png\"]}");
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: rt-fuzz-seeds FOLDER\n";
        return 2;
    }
    const Seeds seeds(argv[1]);
    writeScenes(seeds);
    writeMeshes(seeds);
    writeImages(seeds);
    writeCheckpoints(seeds);
    writeTexts(seeds);
    return 0;
}
