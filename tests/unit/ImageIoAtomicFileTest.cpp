// Output files are replaced wholly or left alone, and nothing else stays behind.
#include <atomic>
#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>

#include <gtest/gtest.h>

#ifdef __linux__
#include <csignal>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#include "Common/Core/AtomicFile.h"
#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/ReadFile.h"
#include "tests/TempFolder.h"

namespace rt {
namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t filesIn(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

void write(const fs::path& path, const std::string& text) {
    AtomicFile file(path);
    file.stream() << text;
    file.commit();
}

std::string errorOf(const fs::path& path) {
    try {
        write(path, std::string(1 << 20, 'x'));
    } catch (const RenderError& e) {
        return e.what();
    }
    return "";
}

TEST(ImageIoAtomicFile, AppearsOnlyWhenCommitted) {
    const test::TempFolder folder;
    {
        AtomicFile file(folder / "a");
        file.stream() << "half";
        EXPECT_FALSE(fs::exists(folder / "a"));
    }
    EXPECT_EQ(filesIn(folder.path()), 0u);

    write(folder / "a", "first");
    {
        AtomicFile file(folder / "a");
        file.stream() << "abandoned" << std::flush;
        EXPECT_EQ(contentOf(folder / "a"), "first");
    }
    EXPECT_EQ(contentOf(folder / "a"), "first");
    write(folder / "a", "2nd");
    EXPECT_EQ(contentOf(folder / "a"), "2nd");
    EXPECT_EQ(filesIn(folder.path()), 1u);
}

TEST(ImageIoAtomicFile, TakesNamesWithoutAFolderAndLongOnes) {
    const test::TempFolder folder;
    const fs::path before = fs::current_path();
    fs::current_path(folder.path());
    write("plain", "here");
    fs::current_path(before);
    EXPECT_EQ(contentOf(folder / "plain"), "here");
    write(folder / std::string(250, 'n'), "long");
    EXPECT_EQ(filesIn(folder.path()), 2u);
}

TEST(ImageIoAtomicFile, ErrorsNameFileAndReason) {
    const test::TempFolder folder;
    EXPECT_NE(errorOf(folder / "none" / "a").find("No such file"), std::string::npos);
    EXPECT_NE(errorOf(folder.path()).find("directory"), std::string::npos);
    write(folder / "file", "x");
    EXPECT_NE(errorOf(folder / "file" / "a").find((folder / "file" / "a").string()), std::string::npos);
    EXPECT_EQ(filesIn(folder.path()), 1u);
}

TEST(ImageIoAtomicFile, RemovesWhatAKilledProgramLeft) {
    const test::TempFolder folder;
    const std::string left = ".rt-0123456789abcdef.tmp", young = ".rt-0123456789abcde0.tmp", other = ".rt-words.tmp";
    for (const std::string& name : {left, young, other}) std::ofstream(folder / name) << "half";
    for (const std::string& name : {left, other})
        fs::last_write_time(folder / name, fs::file_time_type::clock::now() - std::chrono::hours(1));
    AtomicFile atWork(folder / "a");
    EXPECT_FALSE(fs::exists(folder / left));
    EXPECT_TRUE(fs::exists(folder / young)); // somebody may be about to write it
    EXPECT_TRUE(fs::exists(folder / other));

    // A slow writer is not robbed of its file.
    for (const auto& entry : fs::directory_iterator(folder.path()))
        fs::last_write_time(entry.path(), fs::file_time_type::clock::now() - std::chrono::hours(1));
    for (const auto& entry : fs::directory_iterator(folder.path())) removeAbandoned(entry.path());
    EXPECT_EQ(filesIn(folder.path()), 1u);
    atWork.stream() << "whole";
    atWork.commit(AtomicFile::Durability::ToDisk);
    EXPECT_EQ(contentOf(folder / "a"), "whole");
}

TEST(ImageIoAtomicFile, TakesLargePiecesAndSmallOnes) {
    const test::TempFolder folder;
    AtomicFile file(folder / "a");
    std::string expected;
    for (std::size_t size = 1; size < 300'000; size = size * 3 + 1) {
        const std::string piece(size, static_cast<char>('a' + size % 26));
        file.stream() << piece << '.';
        expected += piece + '.';
    }
    file.commit();
    EXPECT_TRUE(contentOf(folder / "a") == expected);
}

#ifdef __linux__
TEST(ImageIoAtomicFile, LeavesAReaderThatStallsOnceInterrupted) {
    const test::TempFolder folder;
    const fs::path pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
    std::atomic<bool> requested{true};
    const Interruptible interruptible(requested);
    write(pipe, "what fits is written all the same");
    EXPECT_NE(errorOf(pipe).find("takes nothing"), std::string::npos);
    close(reader);
}

TEST(ImageIoAtomicFile, WritesDevicesDirectly) {
    write("/dev/null", "gone");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_NE(errorOf("/dev/full").find("/dev/full: No space left"), std::string::npos);
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(ImageIoAtomicFile, WritesAPipeOnlyToAReader) {
    const test::TempFolder folder;
    const fs::path pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_NE(errorOf(pipe).find("pipe: nobody reads from this pipe"), std::string::npos);
    EXPECT_THROW(readFile(pipe, 100), InputError);
    std::string received;
    std::thread reader([&] { received = contentOf(pipe); });
    bool isWritten = false;
    while (!isWritten) { // until the reader is there
        try {
            write(pipe, "whole");
            isWritten = true;
        } catch (const RenderError&) {
            std::this_thread::yield();
        }
    }
    reader.join();
    EXPECT_EQ(received, "whole");
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(ImageIoAtomicFile, AFullDiskLeavesTheOldFile) {
    const test::TempFolder folder;
    write(folder / "a", "old");
    rlimit before = {};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small = {4096, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    const std::string error = errorOf(folder / "a");
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_NE(error.find("a: File too large"), std::string::npos) << error;
    EXPECT_EQ(contentOf(folder / "a"), "old");
    EXPECT_EQ(filesIn(folder.path()), 1u);
}

TEST(ImageIoAtomicFile, FollowsLinks) {
    const test::TempFolder folder;
    fs::create_directory(folder / "elsewhere");
    write(folder / "elsewhere" / "target", "old");
    fs::create_symlink(folder / "elsewhere" / "target", folder / "link");
    write(folder / "link", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(contentOf(folder / "elsewhere" / "target"), "new");
    EXPECT_EQ(filesIn(folder / "elsewhere"), 1u);
}

TEST(ImageIoAtomicFile, KeepsTheModeOfWhatItReplaces) {
    const test::TempFolder folder;
    constexpr fs::perms kPrivate = fs::perms::owner_read | fs::perms::owner_write;
    write(folder / "a", "old");
    EXPECT_NE(fs::status(folder / "a").permissions() & fs::perms::others_read, fs::perms::none);
    for (const fs::perms mode : {kPrivate, fs::perms::owner_read, kPrivate | fs::perms::group_read}) {
        fs::permissions(folder / "a", mode);
        {
            AtomicFile file(folder / "a");
            for (const auto& entry : fs::directory_iterator(folder.path()))
                EXPECT_EQ(entry.status().permissions() & fs::perms::others_all, fs::perms::none) << entry.path();
            file.stream() << "new";
            file.commit();
        }
        EXPECT_EQ(fs::status(folder / "a").permissions(), mode);
    }
}

TEST(ImageIoAtomicFile, NewFilesAreNobodyElses) {
    const test::TempFolder folder;
    write(folder / "target", "old");
    fs::create_symlink(folder / "target", folder / "link");
    fs::create_symlink(folder / "nothing", folder / "dangling");
    for (const char* name : {"target", "link", "dangling"})
        EXPECT_EQ(createExclusively(folder / name, Access::Everybody), std::errc::file_exists) << name;
    EXPECT_FALSE(fs::exists(folder / "nothing"));
    EXPECT_EQ(createNumbered(folder.path(), "a.rtc"), folder / "a.rtc");
    EXPECT_EQ(createNumbered(folder.path(), "a.rtc"), folder / "a.2.rtc");
    EXPECT_EQ(createNumbered(folder.path(), "link"), folder / "link.2");
    EXPECT_THROW(createNumbered(folder / "none", "a.rtc"), RenderError);
}

TEST(ImageIoAtomicFile, NamesAReadOnlyFolder) {
    const test::TempFolder folder;
    fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
    const bool bound = !std::ofstream(folder / "probe"); // root is not
    const std::string error = bound ? errorOf(folder / "a") : "";
    fs::permissions(folder.path(), fs::perms::owner_all);
    if (!bound) GTEST_SKIP() << "permissions do not bind this user";
    EXPECT_NE(error.find("Permission denied"), std::string::npos);
}
#endif

TEST(ImageIoAtomicFile, ReadsOnlyBelowAFolderWhereConfined) {
    const test::TempFolder folder;
    fs::create_directories(folder / "in" / "deep");
    fs::create_directories(folder / "inner");
    for (const char* file : {"in/a", "in/deep/b", "inner/c", "scene"}) write(folder / file, "x");
    fs::create_directory_symlink(folder / "inner", folder / "in" / "link");
    const auto reads = [&](const char* file) {
        try {
            return readFile(folder / file, 10).size() == 1;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("--assets-below does not allow it"), std::string::npos);
            return false;
        }
    };
    {
        const ReadsBelow confined(folder / "in", folder / "scene");
        for (const char* file : {"in/a", "in/deep/b", "in/deep/../a", "scene"}) EXPECT_TRUE(reads(file)) << file;
        for (const char* file : {"inner/c", "in/../inner/c", "in/link/c"}) EXPECT_FALSE(reads(file)) << file;
    }
    EXPECT_TRUE(reads("inner/c"));
    {
        const ReadsBelow unconfined({}, folder / "scene");
        EXPECT_TRUE(reads("inner/c"));
    }
    EXPECT_THROW(ReadsBelow(folder / "none", folder / "scene"), InputError);
}

TEST(ImageIoAtomicFile, ReadFileKeepsToItsLimit) {
    const test::TempFolder folder;
    write(folder / "a", std::string(300000, 'y'));
    EXPECT_EQ(readFile(folder / "a", 300000).size(), 300000u);
    EXPECT_THROW(readFile(folder / "a", 299999), InputError);
    EXPECT_THROW(readFile(folder / "none", 10), InputError);
    write(folder / "empty", "");
    EXPECT_TRUE(readFile(folder / "empty", 10).empty());
#ifdef __linux__
    EXPECT_THROW(readFile("/dev/zero", 1000000), InputError);
    EXPECT_THROW(readFile("/proc/self/maps", 1000000), InputError); // says that it is empty
#endif
}

} // namespace
} // namespace rt
