// rt-fuzz-seeds FOLDER: writes the inputs that fuzzing starts from, FOLDER/TARGET/*, by the writers of this project.
#include <iostream>
#include <random>
#include <sstream>
#include <string>

#include "Common/Image/Checkpoint.h"
#include "Common/Image/ImageIo.h"
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

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: rt-fuzz-seeds FOLDER\n";
        return 2;
    }
    const Seeds seeds(argv[1]);
    writeImages(seeds);
    writeCheckpoints(seeds);
    return 0;
}
