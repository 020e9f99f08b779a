// The runs of both programs on this machine, in one file that both read and append to.
#pragma once
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

namespace rt::app {

// One render. Figures that are not known are 0.
struct RunRecord {
    std::string time; // UTC, "2026-01-31T12:00:00Z"
    std::string app;  // "ray-tracing-cpu"
    std::string engine, device, scene;
    std::string lightSampling, sampler;
    std::uint32_t width = 0, height = 0, maxDepth = 0, threads = 0;
    std::uint64_t spp = 0; // samples that every pixel has
    double loadSeconds = 0, buildSeconds = 0, pipelineSeconds = 0, renderSeconds = 0;
    double samplesPerSecond = 0, raysPerSecond = 0;
    std::string replicates = "1"; // what earlier programs did not write, as they had seldom more
    // What else the work depends on, as the flags take it. Empty in records of programs that did not write it yet; but
    // those had no connections, split no rays and shared no paths: they read as "off".
    std::string sceneHash, camera; // 16 hexadecimal digits; JSON as a window copies it
    std::string lightSelection, sphereLight, quadLight, triangleLight, russianRoulette, oneSidedLights, adaptive,
        specularConnections, edgeRays, pathReuse;
    double relmse = 0;
    bool isSoftware = false;   // the device is a driver that works on the processor
    bool hasReference = false; // relmse is against a reference; otherwise the film's own estimate
    double referenceError = 0; // the reference's own relMSE, estimated; 0: not known
    struct Point {
        double seconds = 0, relmse = 0;
        bool operator==(const Point&) const = default;
    };
    std::vector<Point> curve; // error against time, with a reference
    bool operator==(const RunRecord&) const = default;

    double efficiency() const { return relmse > 0 && renderSeconds > 0 ? 1 / (relmse * renderSeconds) : 0; }
};

// history.jsonl: a JSON object with "version" a line. Lines that are damaged or of a later version are kept but not
// shown.
class RunHistory {
  public:
    static constexpr std::size_t kMaxLines = 10'000; // kept in the file

    // An empty path: nothing is kept from one program to the next.
    explicit RunHistory(std::filesystem::path file) : file_(std::move(file)) {}

    // On any thread. Under a lock that both programs respect. Throws RenderError. The oldest lines go when there are
    // too many.
    void append(const RunRecord& record);
    // On the thread that reads the records. The lines of these go, all others stay as they are; the file is replaced as
    // a whole, under the same lock. Throws RenderError.
    void remove(std::vector<RunRecord> records); // a copy: it may be those that records() has returned
    // On one thread. The records of the file, oldest first; read again only when the file has changed.
    const std::vector<RunRecord>& records();

    // Grows with each change of what records() returned last.
    std::uint64_t serial() const { return serial_; }

    static std::filesystem::path userFile(); // empty where there is no place for it

  private:
    // A file of its own is locked, as the history is replaced when it is shortened.
    std::filesystem::path lockFile() const { return file_.string() + ".lock"; }

    std::filesystem::path file_;
    std::vector<RunRecord> records_;
    std::mutex mutex_;               // guards what follows
    std::vector<RunRecord> unfiled_; // without a file: appended and not in the records yet
    std::filesystem::file_time_type readTime_{};
    std::uintmax_t readSize_ = 0;
    bool wasRead_ = false;
    std::uint64_t serial_ = 0;
};

// The names of what a record does not tell of its work, with commas; empty: it tells all.
std::string lackingIn(const RunRecord& record);
// What the work depends on, the same for every record: what it is called, and its value as text, empty where the record
// lacks it. Scene hash and camera are not meant to be read.
struct WorkField {
    const char* title;
    std::string value;
    bool isShort = true;      // what a cell of a table has room for
    bool isOfPicture = false; // what more samples come to depends on it
};
std::vector<WorkField> workOf(const RunRecord& record);

// Whether all that the work depends on is known of both and equal. Engine, device and threads are left free.
bool isSameWork(const RunRecord& a, const RunRecord& b);
// Whether they make the same picture but for its noise: scene, camera, size, depth and sides of lights are equal.
bool isSamePicture(const RunRecord& a, const RunRecord& b);

// One run of each program; both or none.
struct EnginePair {
    const RunRecord* cpu = nullptr;
    const RunRecord* gpu = nullptr;
};
// The newest runs of both programs that did the same work, where their speed is known.
EnginePair newestOfEqualWork(const std::vector<const RunRecord*>& newestFirst);

std::string toJsonLine(const RunRecord& record); // without the line's end
std::string toCsv(const std::vector<RunRecord>& records);
std::string utcNow();

// A text as a field of CSV: with commas or quotes it is quoted as in RFC 4180.
std::string csvField(const std::string& text);

} // namespace rt::app
