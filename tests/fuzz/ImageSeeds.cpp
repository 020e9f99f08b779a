// rt-fuzz-image-seeds FOLDER: image files and checkpoints, which need no more than the image library.
#include <random>
#include <sstream>

#include "Common/Image/Checkpoint.h"
#include "Common/Image/ImageIo.h"
#include "tests/fuzz/Seeds.h"
#include "tests/unit/ExrFiles.h"

namespace {

using rt::test::Seeds;
namespace fs = std::filesystem;

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
    using rt::test::exrFile;
    for (const auto compression :
         {Imf::RLE_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION,
          Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION})
        for (const auto type : {Imf::UINT, Imf::HALF, Imf::FLOAT})
            seeds.write("exr", "lines-" + std::to_string(compression) + '-' + std::to_string(type),
                        exrFile(image, {.type = type, .compression = compression}));
    seeds.write("exr", "tiles", exrFile(image, {.type = Imf::HALF, .levels = Imf::ONE_LEVEL}));
    seeds.write("exr", "levels", exrFile(image, {.compression = Imf::ZIP_COMPRESSION, .levels = Imf::RIPMAP_LEVELS}));
    seeds.write("exr", "parts", rt::test::exrFileOfParts({image, image}, {.lineOrder = Imf::DECREASING_Y}));
    seeds.write("exr", "deep", rt::test::deepExrFile());
    seeds.write("exr", "chroma", exrFile(image, {.channels = {"Y", "RY", "BY"}, .type = Imf::HALF}));
    seeds.write("exr", "layer", exrFile(image, {.channels = {"a.R", "a.G", "a.B"}}));
    seeds.write("hdr", "header",
                "#?RADIANCE\nEXPOSURE=2\nCOLORCORR=1 2 3\nPRIMARIES=0.64 0.33 0.29 0.6 0.15 0.06 0.333 0.333\n"
                "FORMAT=32-bit_rle_xyze\n\n-Y 1 +X 4\n\x80\x90\xa0\x80" +
                    std::string("\1\1\1\3", 4));
    // 1 x 1, 24 bits, uncompressed.
    const char bmp[] =
        "BM\x3a\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\1\0\0\0\1\0\0\0\1\0\x18\0\0\0\0\0\4\0\0\0\0\0\0\0\0\0"
        "\0\0\0\0\0\0\0\0\0\0\x10\x80\xff";
    seeds.write("bmp", "one", std::string(bmp, sizeof bmp));
    // 2 x 1, 8 bits in runs, two colours.
    const char runs[] =
        "BM\x44\0\0\0\0\0\0\0\x3e\0\0\0\x28\0\0\0\2\0\0\0\1\0\0\0\1\0\10\0\1\0\0\0\6\0\0\0\0\0\0\0\0\0"
        "\0\0\2\0\0\0\0\0\0\0\x10\x80\xff\0\1\2\3\0\2\1\0\0\0\1";
    seeds.write("bmp", "runs", std::string(runs, sizeof runs - 1));
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
    return rt::test::writeSeeds(argc, argv, [](Seeds& seeds) {
        writeImages(seeds);
        writeCheckpoints(seeds);
    });
}
