// A screen of its own (Xvfb) with one of the programs on it, driven by keyboard and mouse (xdotool).
#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gui/Framebuffer.h"

namespace rt::test {

class Desktop : public testing::Test {
  protected:
    static constexpr int kWidth = 1280, kHeight = 900; // of the screen

    void SetUp() override;
    void TearDown() override;

    // Starts "ray-tracing-cpu" or "ray-tracing-gpu" with validation, a small image and no stored settings but those of
    // this test; waits for its window.
    void start(const std::string& program, const std::vector<std::string>& arguments = {});
    void launch(const std::string& program, const std::vector<std::string>& arguments); // does not wait
    // Closes the window by Ctrl+Q; the exit code tells of validation's messages, too.
    int quit();
    int endBySignal(int signal); // the exit code
    int waitForEnd();            // of the program, by itself: the exit code
    bool isVisible();            // whether its window is there, from now on the one that is acted on
    bool isRunning();
    std::string log() const; // what the program has written

    // Commands of xdotool, in one go: "mousemove 10 20 click 1".
    void act(const std::string& commands);
    void key(const std::string& name) { act("key " + name); }
    void type(const std::string& text);
    std::string title();
    void resize(int width, int height);
    void minimise(bool minimised);
    void freeze(bool frozen);                           // as on a machine that is too busy for the program
    void setDotsPerInch(int dots);                      // of the screen, before start()
    void paintOver(unsigned side, std::uint32_t color); // the window's corner, until it draws
    void expose();                                      // asks it to draw what it shows
    void destroyWindow();                               // as no program should do to another
    void endScreen();                                   // as at the end of a user's session
    // Drops files on the window, at a place in it, as another program would; whether they were taken.
    bool drop(const std::vector<std::string>& files, int x = 1, int y = 1);
    std::uint64_t residentBytes() const;
    bool isBusy() const; // whether any of its threads runs, or would on a machine with less to do
    Screenshot screenshot() const { return framebuffer_ ? framebuffer_->look() : Screenshot{}; }
    bool hasChild() const; // whether the program runs another one

    // Waits for what takes a while on a busy machine; the time only ends a test that fails.
    static bool eventually(const std::function<bool()>& condition,
                           std::chrono::milliseconds patience = std::chrono::seconds(240));
    static void pause(int milliseconds);

    std::filesystem::path folder_; // of this test: settings, pictures, files

    std::vector<std::pair<std::string, std::string>> environment_; // of the programs, besides

  private:
    std::string display_; // ":99"
    std::unique_ptr<Framebuffer> framebuffer_;
    int screen_ = -1; // processes
    int program_ = -1;
    std::string window_; // xdotool's number
};

} // namespace rt::test
