// Checkpoints, as they are and with hashes that fit: else no mutation would get past those. What is read can be written
// and has the same bytes.
#include "Common/Image/Checkpoint.h"

#include <cstring>
#include <span>
#include <sstream>

#include "Common/Core/Hash.h"
#include "tests/fuzz/Fuzz.h"

namespace {

void read(const std::string& bytes) {
    using namespace rt;
    test::readOrRefuse([&] {
        std::istringstream in(bytes);
        const image::Checkpoint checkpoint = image::readCheckpoint(in, "f.rtc");
        std::ostringstream out;
        image::writeCheckpoint(out, checkpoint.render, checkpoint.film);
        checkpoint.film.resolve();
    });
}

// At `place`, 8 bytes, the hash of those from `begin` to there.
void seal(std::string& bytes, std::size_t begin, std::size_t place) {
    const std::uint64_t hash = rt::hashBytes(std::as_bytes(std::span(bytes).subspan(begin, place - begin)));
    std::memcpy(&bytes[place], &hash, sizeof hash);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t kSizePlace = 12, kHeader = 16; // Checkpoint.h shows the layout
    constexpr std::size_t kHash = sizeof(std::uint64_t);
    std::string bytes(rt::test::textOf(data, size));
    read(bytes);
    if (size < kHeader + 2 * kHash) return 0;
    std::uint32_t headerSize = 0;
    std::memcpy(&headerSize, &bytes[kSizePlace], sizeof headerSize);
    if (headerSize > size - kHeader - 2 * kHash) return 0;
    const std::size_t headerEnd = kHeader + headerSize;
    seal(bytes, kHeader, headerEnd);
    seal(bytes, headerEnd + kHash, size - kHash);
    read(bytes);
    return 0;
}
