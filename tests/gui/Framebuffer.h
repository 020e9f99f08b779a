// What is on a screen of Xvfb, read where the server draws it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace rt::test {

// All that is on the screen. Copies share their pixels, and so do screenshots between which nothing has changed.
struct Screenshot {
    using Pixels = std::vector<std::uint32_t>; // 0xrrggbb, row after row

    int width = 0, height = 0;
    std::shared_ptr<const Pixels> pixels = std::make_shared<const Pixels>();

    std::uint32_t at(int x, int y) const {
        return pixels->at(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    }
};

// Tests look again and again: to ask the server for all pixels, each time, costs more than what is awaited.
class Framebuffer {
  public:
    // Of a server that runs with "-fbdir" and this folder. Ends before the server does.
    Framebuffer(const std::string& display, const std::filesystem::path& folder);
    ~Framebuffer();
    Framebuffer(const Framebuffer&) = delete;
    Framebuffer& operator=(const Framebuffer&) = delete;

    Screenshot look(); // between two requests of the server's clients

  private:
    struct Server; // a connection to it, and its file
    std::unique_ptr<Server> server_;
    std::vector<std::uint32_t> seen_; // as the server has them, whose fourth byte means nothing
    Screenshot last_;
};

} // namespace rt::test
