// The film's part of a checkpoint: sample counts, of an adaptive film whether it has a plan (1) and the plan, sums,
// squares if kept, the open blocks that exist, and a hash of them all.
#include <algorithm>
#include <bit>
#include <cmath>
#include <istream>
#include <optional>
#include <ostream>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Core/Hash.h"
#include "Common/Image/Film.h"

namespace rt::image {

static_assert(std::endian::native == std::endian::little, "the state is stored as it lies in memory");

namespace {

class StateWriter {
  public:
    explicit StateWriter(std::ostream& out) : out_(out) {}
    template <class T>
    void put(std::span<const T> values) {
        const auto bytes = std::as_bytes(values);
        out_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        hash_ = hashBytes(bytes, hash_);
    }
    std::uint64_t hash() const { return hash_; }

  private:
    std::ostream& out_;
    std::uint64_t hash_ = kHashStart;
};

class StateReader {
  public:
    StateReader(std::istream& in, const std::string& name) : in_(in), name_(name) {}
    template <class T>
    void get(std::span<T> values) {
        const auto bytes = std::as_writable_bytes(values);
        in_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        if (!in_) fail("ends before its image does");
        hash_ = hashBytes(bytes, hash_);
    }
    std::uint64_t hash() const { return hash_; }
    [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": checkpoint " + what); }

  private:
    std::istream& in_;
    const std::string& name_;
    std::uint64_t hash_ = kHashStart;
};

// Bytes from the read position to the end; nothing for a stream that cannot tell.
std::optional<double> remainingBytes(std::istream& in) {
    const auto here = in.tellg();
    if (here < 0) return std::nullopt;
    in.seekg(0, std::ios::end);
    const auto end = in.tellg();
    in.seekg(here);
    return static_cast<double>(end - here);
}

} // namespace

void Film::writeState(std::ostream& out) const {
    StateWriter writer(out);
    writer.put(std::span(samples_));
    const std::uint32_t planned = hasPlan() ? 1 : 0;
    if (desc_.adaptive) writer.put(std::span(&planned, 1));
    writer.put(std::span(plan_));
    writer.put(std::span(sums_));
    writer.put(std::span(squares_));
    for (std::size_t at = 0; at < slotCount(); ++at) writer.put(openBlock(at));
    const std::uint64_t hash = writer.hash();
    writer.put(std::span(&hash, 1));
}

Film Film::readState(const FilmDesc& desc, std::istream& in, const std::string& name) {
    StateReader reader(in, name);
    const double minimum = 1.0 * desc.width * desc.height * desc.replicates * 3 * sizeof(double); // bytes
    if (remainingBytes(in).value_or(minimum) < minimum) reader.fail("ends before its image does");

    Film film(desc);
    reader.get(std::span(film.samples_));
    std::uint32_t planned = 0;
    if (desc.adaptive) reader.get(std::span(&planned, 1));
    if (planned > 1) reader.fail("is damaged: it neither has a plan nor lacks one");
    if (planned == 1) {
        std::vector<std::uint32_t> plan(film.slotCount() * kTilePixels);
        reader.get(std::span(plan));
        film.setPlan(std::move(plan));
    }
    reader.get(std::span(film.sums_));
    reader.get(std::span(film.squares_));
    for (std::size_t at = 0; at < film.slotCount(); ++at) {
        if (film.samples_[at] > kMaxSamples || (planned == 1 && film.ends_[at] > kMaxSamples))
            reader.fail("is damaged: a sample count is too large");
        if (film.samples_[at] % kBlock == 0) continue;
        film.reserveOpenBlocks();
        reader.get(std::span(&film.open_[at * kTileValues], kTileValues));
    }
    const std::uint64_t expected = reader.hash();
    std::uint64_t hash = 0;
    reader.get(std::span(&hash, 1));
    if (hash != expected) reader.fail("is damaged: its hash does not fit its content");
    // Radiance is neither, and one such pixel would spoil every figure of the whole image.
    const auto isImpossible = [](auto value) { return !(value >= 0 && std::isfinite(value)); };
    const auto hasImpossible = [&](const auto& values) {
        return std::any_of(values.begin(), values.end(), isImpossible);
    };
    if (hasImpossible(film.sums_) || hasImpossible(film.squares_) || hasImpossible(film.open_))
        reader.fail("is damaged: a sum is negative or not finite");
    return film;
}

} // namespace rt::image
