// OpenEXR images, written by the format's own library: uncompressed scan lines of 32-bit float.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <cstdint>
#include <ostream>
#include <vector>

#include "Common/Image/Codecs.h"

namespace rt::image {

namespace {

// The file goes to a stream that cannot go back, as a pipe: the table of where rows are, which the library leaves empty
// until it has written them, is filled in beforehand, and what it writes over earlier bytes is dropped. Errors are left
// to the state of `out`, since an exception must not leave the destructor of the library's file.
class ForwardStream : public Imf::OStream {
  public:
    explicit ForwardStream(std::ostream& out) : OStream(""), out_(out) {}

    void write(const char bytes[], int count) override {
        if (position_ == end_) {
            if (isHead_)
                head_.append(bytes, static_cast<std::size_t>(count));
            else
                out_.write(bytes, count);
            end_ += static_cast<std::uint64_t>(count);
        }
        position_ += static_cast<std::uint64_t>(count);
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }

    // What was written until now ends with the table of `rows` rows; `rowBytes` of values follow for each.
    void fillTable(std::uint32_t rows, std::uint64_t rowBytes) {
        constexpr std::uint64_t kRowHead = 8; // y and size
        std::size_t at = head_.size() - rows * sizeof(std::uint64_t);
        for (std::uint32_t y = 0; y < rows; ++y) {
            const std::uint64_t offset = end_ + y * (kRowHead + rowBytes);
            for (int shift = 0; shift < 64; shift += 8) head_[at++] = static_cast<char>(offset >> shift & 0xff);
        }
        out_.write(head_.data(), static_cast<std::streamsize>(head_.size()));
        head_ = {};
        isHead_ = false;
    }

  private:
    std::ostream& out_;
    std::string head_; // headers and table
    bool isHead_ = true;
    std::uint64_t position_ = 0, end_ = 0;
};

} // namespace

void encodeExr(const ImageRows& image, std::ostream& out, const std::string& description) {
    Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
    header.compression() = Imf::NO_COMPRESSION;
    if (!description.empty()) header.insert(kDescriptionKey, Imf::StringAttribute(description));

    std::vector<float> row(image.rowValues());
    Imf::FrameBuffer pixels; // the same memory for all rows
    const std::string channels = image.channels == 3 ? "RGB" : "Y";
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const std::string name(1, channels[c]);
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        pixels.insert(
            name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(row.data() + c), channels.size() * sizeof(float), 0));
    }

    ForwardStream stream(out);
    Imf::OutputFile file(stream, header, 0); // no threads
    stream.fillTable(image.height, row.size() * sizeof(float));
    file.setFrameBuffer(pixels);
    for (std::uint32_t y = 0; y < image.height; ++y) {
        image.read(y, row);
        file.writePixels();
    }
}

} // namespace rt::image
