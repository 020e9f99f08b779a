#include "Common/App/Interactive/AutosaveFiles.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <random>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "Common/Core/Error.h"
#include "Common/Core/Hash.h"
#include "Common/Core/NewFile.h"
#include "Common/Core/OutputFile.h"
#include "Common/Core/Paths.h"
#include "Common/Core/ReadFile.h"
#include "Common/Core/TimeText.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Json/JsonText.h"

namespace rt::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* kAutosaveEnding = ".autosave";
constexpr std::uint32_t kAutosaveVersion = 1;
constexpr std::uint64_t kMaxAutosaveBytes = std::uint64_t{4} << 30;
constexpr std::size_t kHashDigits = 16;

fs::path lockOf(const fs::path& file) {
    return fs::path(file) += ".lock";
}

std::int64_t secondsSinceEpoch() {
    using std::chrono::system_clock;
    return std::chrono::duration_cast<std::chrono::seconds>(system_clock::now().time_since_epoch()).count();
}

std::int64_t ticksOf(const FileFingerprint& mark) {
    return static_cast<std::int64_t>(mark.written.time_since_epoch().count());
}

std::string guardedLine(const std::string& text) {
    return hexText(hashBytes(std::as_bytes(std::span(text)))) + ' ' + text + '\n';
}

// The texts of all lines that were written wholly. Throws InputError where one is not what was written.
std::vector<std::string> readGuardedLines(const fs::path& file) {
    const std::vector<std::byte> bytes = readFile(file, kMaxAutosaveBytes);
    std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::vector<std::string> lines;
    for (std::size_t end = rest.find('\n'); end != rest.npos; end = rest.find('\n')) {
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(end + 1);
        const std::string text(line.substr(std::min(line.size(), kHashDigits + 1)));
        if (line.substr(0, kHashDigits) != hexText(hashBytes(std::as_bytes(std::span(text)))))
            throw InputError(file.string() + ": line " + std::to_string(lines.size() + 1) +
                             " is not what was written there");
        lines.push_back(text);
    }
    if (lines.empty()) throw InputError(file.string() + ": holds no line that was written wholly");
    return lines;
}

// Nothing: a newer program has written it, and will read it.
std::optional<LeftAutosave> readHeader(const std::string& line, const fs::path& file) {
    const std::string name = file.string();
    const nlohmann::json json = scene::parseJson(line, name);
    const scene::JsonNode node(json, name);
    if (node.at("autosave").unsignedInteger() > kAutosaveVersion) return std::nullopt;
    LeftAutosave left;
    left.file = file;
    left.process = node.at("process").unsignedInteger();
    left.scene.source = node.at("scene").string();
    left.scene.title = node.at("title").string();
    left.scene.moment = {node.at("animation").string(), node.at("time").number(), false, node.has("whole")};
    if (node.has("bytes")) {
        using Duration = fs::file_time_type::duration;
        const nlohmann::json &written = node.at("written").value(), &bytes = node.at("bytes").value();
        if (!written.is_number_integer() || !bytes.is_number_unsigned()) node.fail("must have whole numbers");
        left.scene.mark = FileFingerprint{
            left.scene.source, fs::file_time_type(Duration(static_cast<Duration::rep>(written.get<std::int64_t>()))),
            bytes.get<std::uintmax_t>()};
    }
    return left;
}

// Behind the time, and 1 or 0: whether the step leaves something unsaved.
struct TimedStep {
    std::int64_t seconds = 0;
    bool leavesUnsaved = false;
    std::string_view step;
};
TimedStep timedStep(std::string_view line, const fs::path& file) {
    constexpr std::size_t kMaxDigits = 12, kFlag = 3; // of the time; " 1 "
    const std::size_t blank = line.find_first_not_of("0123456789");
    if (blank == line.npos || blank == 0 || blank > kMaxDigits || line.size() < blank + kFlag)
        throw InputError(file.string() + ": a step must begin with its time");
    return {std::stoll(std::string(line.substr(0, blank))), line[blank + 1] == '1', line.substr(blank + kFlag)};
}

// Nothing where there is nothing to be had back.
std::optional<LeftAutosave> lookAtAutosave(const fs::path& file) {
    const std::vector<std::string> lines = readGuardedLines(file);
    std::optional<LeftAutosave> left = readHeader(lines.front(), file);
    if (!left || lines.size() == 1) return left;
    const TimedStep last = timedStep(lines.back(), file);
    left->when = localTimeText(static_cast<std::time_t>(last.seconds), "%Y-%m-%d %H:%M");
    if (last.leavesUnsaved) left->steps = lines.size() - 1;
    return left;
}

} // namespace

std::string wholeSource(const std::string& source) {
    std::error_code none;
    const bool isThere = fs::exists(source, none);
    const fs::path whole = isThere ? fs::absolute(source, none) : fs::path(source);
    return whole.string();
}

fs::path autosaveFolder() {
    const fs::path state = userStateFolder();
    return state.empty() ? state : state / "autosave";
}

std::string autosaveHeader(const EditedScene& scene, const std::string& program) {
    nlohmann::ordered_json json = {{"autosave", kAutosaveVersion}, {"program", program},
                                   {"process", processId()},       {"scene", scene.source},
                                   {"title", scene.title},         {"animation", scene.moment.animation},
                                   {"time", scene.moment.time}};
    if (scene.moment.isWhole) json["whole"] = true;
    if (scene.mark) {
        json["written"] = ticksOf(*scene.mark);
        json["bytes"] = scene.mark->bytes;
    }
    return guardedLine(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

std::string autosaveLine(const scene::EditStep& step) {
    return guardedLine(std::to_string(secondsSinceEpoch()) + (step.leavesUnsaved ? " 1 " : " 0 ") + toText(step));
}

ClaimedAutosave ClaimedAutosave::make(const fs::path& folder, const std::string& program) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw RenderError(folder.string() + ": cannot be made: " + error.message());
    std::random_device random;
    while (true) {
        const std::string name = program + '-' + std::to_string(processId()) + '-' + std::to_string(random());
        const fs::path file = folder / (name + kAutosaveEnding);
        std::unique_ptr<FileLock> lock = FileLock::ifFree(lockOf(file)); // first: nobody takes the file for left
        if (!lock) continue;
        error = createExclusively(file, Access::OwnerOnly);
        if (!error) return {file, std::move(lock)};
        lock.reset();
        std::error_code ignored;
        fs::remove(lockOf(file), ignored);
        if (error != std::errc::file_exists) throw RenderError(file.string() + ": " + error.message());
    }
}

std::optional<ClaimedAutosave> ClaimedAutosave::take(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return std::nullopt;
    std::unique_ptr<FileLock> lock = FileLock::ifFree(lockOf(file));
    if (lock && fs::is_regular_file(file, error)) return ClaimedAutosave(file, std::move(lock));
    return std::nullopt; // who had it may have removed it meanwhile
}

void ClaimedAutosave::remove() {
    std::error_code ignored;
    fs::remove(file_, ignored);
    lock_.reset();
    fs::remove(lockOf(file_), ignored);
}

std::string ClaimedAutosave::keepAside() {
    fs::path aside = file_;
    aside.replace_extension(".damaged");
    std::error_code error, ignored;
    fs::rename(file_, aside, error);
    lock_.reset();
    if (!error) fs::remove(lockOf(file_), ignored);
    return error ? "it stays where it is" : "kept as " + aside.filename().string();
}

LeftAutosaves findAutosaves(const fs::path& folder) {
    LeftAutosaves found;
    if (folder.empty()) return found;
    for (const std::string& name : namesIn(folder)) {
        const fs::path file = folder / name;
        if (file.extension() != kAutosaveEnding) continue;
        try {
            std::optional<ClaimedAutosave> claimed = ClaimedAutosave::take(file);
            if (!claimed) continue;
            std::optional<LeftAutosave> left;
            try {
                left = lookAtAutosave(file);
            } catch (const InputError& error) {
                found.complaints.push_back(
                    std::string("unsaved edits cannot be recovered, as their file is damaged: ") + error.what() + " (" +
                    claimed->keepAside() + ')');
                continue;
            }
            if (left && left->steps == 0) claimed->remove();
            if (left && left->steps > 0) found.files.push_back(std::move(*left));
        } catch (const std::exception& error) { // no lock to be had, or no memory
            found.complaints.push_back("unsaved edits cannot be looked at: " + messageOf(error));
        }
    }
    const auto isLater = [](const LeftAutosave& a, const LeftAutosave& b) { return a.when > b.when; };
    std::sort(found.files.begin(), found.files.end(), isLater);
    return found;
}

std::vector<scene::EditStep> readAutosave(const ClaimedAutosave& claimed, const std::string& assetsBelow) {
    const std::vector<std::string> lines = readGuardedLines(claimed.file());
    std::vector<scene::EditStep> steps;
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const TimedStep timed = timedStep(lines[i], claimed.file());
        steps.push_back(scene::parseStep(std::string(timed.step), claimed.file().string(), assetsBelow));
    }
    return steps;
}

} // namespace rt::app
