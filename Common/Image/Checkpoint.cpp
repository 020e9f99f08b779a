#include "Common/Image/Checkpoint.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "Common/Core/AtomicFile.h"
#include "Common/Core/Error.h"
#include "Common/Core/Hash.h"

namespace rt::image {

namespace {

constexpr char kMagic[8] = {'R', 'T', 'C', 'H', 'E', 'C', 'K', '\n'};
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kMaxHeaderBytes = 1u << 20;
constexpr int kMaxDepth = 64; // of values within values: copies of the header recurse

std::uint64_t hashText(const std::string& text) {
    return hashBytes(std::as_bytes(std::span(text)));
}

nlohmann::json toJson(const FilmDesc& desc) {
    return {{"width", desc.width},
            {"height", desc.height},
            {"replicates", desc.replicates},
            {"second_moments", desc.secondMoments},
            {"adaptive", desc.adaptive}};
}

FilmDesc toFilmDesc(const nlohmann::json& json) {
    return {json.at("width"), json.at("height"), json.at("replicates"), json.at("second_moments"),
            json.value("adaptive", false)}; // which checkpoints of the first versions do not say
}

class Reader {
  public:
    Reader(std::istream& in, const std::string& name) : in_(in), name_(name) {}
    void read(void* target, std::size_t bytes) {
        if (!in_.read(static_cast<char*>(target), static_cast<std::streamsize>(bytes)))
            fail("checkpoint ends before its header does");
    }
    template <class T>
    T number() {
        T value;
        read(&value, sizeof value);
        return value;
    }
    [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }
    std::istream& stream() { return in_; }

  private:
    std::istream& in_;
    const std::string& name_;
};

nlohmann::json readHeader(Reader& in) {
    char magic[sizeof kMagic] = {};
    in.stream().read(magic, sizeof magic);
    if (std::memcmp(magic, kMagic, sizeof kMagic) != 0) in.fail("not a checkpoint");
    if (const auto version = in.number<std::uint32_t>(); version != kVersion)
        in.fail("checkpoint has version " + std::to_string(version) + " (supported: " + std::to_string(kVersion) + ")");
    const auto size = in.number<std::uint32_t>();
    if (size > kMaxHeaderBytes) in.fail("checkpoint is damaged: its header is too large");
    std::string text(size, '\0');
    in.read(text.data(), size);
    if (in.number<std::uint64_t>() != hashText(text))
        in.fail("checkpoint is damaged: the header's hash does not fit it");
    return nlohmann::json::parse(text, [&in](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
        if (depth > kMaxDepth)
            in.fail("checkpoint is damaged: its header is nested deeper than " + std::to_string(kMaxDepth));
        return true;
    });
}

} // namespace

void writeCheckpoint(const std::filesystem::path& path, const nlohmann::json& render, const Film& film) {
    AtomicFile file(path);
    writeCheckpoint(file.stream(), render, film);
    file.commit(AtomicFile::Durability::ToDisk);
}

void writeCheckpoint(std::ostream& out, const nlohmann::json& render, const Film& film) {
    const std::string text = nlohmann::json{{"film", toJson(film.desc())}, {"render", render}}.dump();
    const auto size = static_cast<std::uint32_t>(text.size());
    const std::uint64_t hash = hashText(text);
    out.write(kMagic, sizeof kMagic);
    out.write(reinterpret_cast<const char*>(&kVersion), sizeof kVersion);
    out.write(reinterpret_cast<const char*>(&size), sizeof size);
    out << text;
    out.write(reinterpret_cast<const char*>(&hash), sizeof hash);
    film.writeState(out);
}

std::vector<std::string> addLaterFields(nlohmann::json& render) {
    std::vector<std::string> added;
    if (!render.is_object()) return added;
    for (const char* field : kLaterFields)
        if (render.emplace(field, "off").second) added.emplace_back(field);
    return added;
}

Checkpoint readCheckpoint(const std::filesystem::path& path) {
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
        throw InputError("cannot read " + path.string() + ": it is not a regular file"); // it might wait for ever
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    if (!in)
        throw InputError("cannot read " + path.string() + ": " +
                         std::generic_category().message(errno == 0 ? EIO : errno));
    return readCheckpoint(in, path.string());
}

Checkpoint readCheckpoint(std::istream& stream, const std::string& name) {
    Reader in(stream, name);
    try {
        const nlohmann::json header = readHeader(in);
        Checkpoint checkpoint{header.at("render"), {}};
        checkpoint.film = Film::readState(toFilmDesc(header.at("film")), stream, name);
        if (stream.peek() != std::istream::traits_type::eof())
            in.fail("checkpoint is damaged: it goes on after its end");
        return checkpoint;
    } catch (const nlohmann::json::exception& error) {
        in.fail(std::string("checkpoint is damaged: ") + error.what());
    } catch (const UsageError& error) { // a size that no film can have
        in.fail(std::string("checkpoint is damaged: ") + error.what());
    }
}

} // namespace rt::image
