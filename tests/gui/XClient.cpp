#include "tests/gui/XClient.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <chrono>
#include <memory>
#include <thread>

#undef None // a macro of X11 and a word of our enumerators, where sources are merged

namespace rt::test {
namespace {

constexpr Atom kNoAtom = 0;
constexpr long kXdndVersion = 5;
constexpr long kNormalState = 1, kIconicState = 3; // of WM_STATE (ICCCM 4.1.3.1)

struct Closer {
    void operator()(Display* display) const { XCloseDisplay(display); }
};
using Connection = std::unique_ptr<Display, Closer>;

std::string uriList(const std::vector<std::string>& files) {
    constexpr char kHex[] = "0123456789ABCDEF";
    std::string list;
    for (const std::string& file : files) {
        list += "file://";
        for (const char c : file) {
            const auto byte = static_cast<unsigned char>(c);
            const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '/' ||
                               c == '.' || c == '-' || c == '_';
            if (plain)
                list += c;
            else
                list.append({'%', kHex[byte >> 4], kHex[byte & 15]});
        }
        list += "\r\n";
    }
    return list;
}

// The program that files are dragged from.
class Source {
  public:
    Source(Display* display, Window target, std::string data)
        : display_(display),
          target_(target),
          data_(std::move(data)),
          window_(XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0)) {}
    ~Source() { XDestroyWindow(display_, window_); }
    Source(const Source&) = delete;
    Source& operator=(const Source&) = delete;

    bool drop(int inX, int inY) {
        XSetSelectionOwner(display_, atom("XdndSelection"), window_, CurrentTime);
        send("XdndEnter", kXdndVersion << 24, static_cast<long>(type_));
        int x = 0, y = 0;
        Window child = 0;
        XTranslateCoordinates(display_, target_, DefaultRootWindow(display_), inX, inY, &x, &y, &child);
        send("XdndPosition", 0, static_cast<long>(x) << 16 | y, CurrentTime, static_cast<long>(atom("XdndActionCopy")));
        if ((answer("XdndStatus") & 1) == 0) return false;
        send("XdndDrop", 0, CurrentTime);
        return answer("XdndFinished") >= 0;
    }

  private:
    Atom atom(const char* name) const { return XInternAtom(display_, name, False); }

    void send(const char* message, long a, long b, long c = 0, long d = 0) {
        XEvent event{};
        event.xclient.type = ClientMessage;
        event.xclient.window = target_;
        event.xclient.message_type = atom(message);
        event.xclient.format = 32;
        const long data[] = {static_cast<long>(window_), a, b, c, d};
        for (int i = 0; i < 5; ++i) event.xclient.data.l[i] = data[i];
        XSendEvent(display_, target_, False, NoEventMask, &event);
        XFlush(display_);
    }

    // Waits for a message, and hands the data out meanwhile. Its second word; -1: it does not come.
    long answer(const char* message) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (std::chrono::steady_clock::now() < end) {
            if (XPending(display_) == 0) {
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
                continue;
            }
            XEvent event;
            XNextEvent(display_, &event);
            if (event.type == SelectionRequest) handOut(event.xselectionrequest);
            if (event.type == ClientMessage && event.xclient.message_type == atom(message))
                return event.xclient.data.l[1];
        }
        return -1;
    }

    void handOut(const XSelectionRequestEvent& request) {
        XChangeProperty(display_, request.requestor, request.property, request.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(data_.data()), static_cast<int>(data_.size()));
        XEvent answer{};
        answer.xselection.type = SelectionNotify;
        answer.xselection.requestor = request.requestor;
        answer.xselection.selection = request.selection;
        answer.xselection.target = request.target;
        answer.xselection.property = request.property;
        answer.xselection.time = request.time;
        XSendEvent(display_, request.requestor, False, NoEventMask, &answer);
        XFlush(display_);
    }

    Display* display_;
    Window target_;
    std::string data_;
    Window window_;
    Atom type_ = atom("text/uri-list");
};

} // namespace

bool dropFiles(const std::string& display, unsigned long window, const std::vector<std::string>& files, int x, int y) {
    const Connection connection(XOpenDisplay(display.c_str()));
    return connection && Source(connection.get(), window, uriList(files)).drop(x, y);
}

void setMinimised(const std::string& display, unsigned long window, bool minimised) {
    const Connection connection(XOpenDisplay(display.c_str()));
    if (!connection) return;
    const Atom state = XInternAtom(connection.get(), "WM_STATE", False);
    const long value[] = {minimised ? kIconicState : kNormalState, kNoAtom};
    XChangeProperty(connection.get(), window, state, state, 32, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(value), 2);
    minimised ? XUnmapWindow(connection.get(), window) : XMapWindow(connection.get(), window);
    XSync(connection.get(), False);
}

void paintOver(const std::string& display, unsigned long window, unsigned side, std::uint32_t color) {
    const Connection connection(XOpenDisplay(display.c_str()));
    if (!connection) return;
    const GC context = XCreateGC(connection.get(), window, 0, nullptr);
    XSetForeground(connection.get(), context, color);
    XFillRectangle(connection.get(), window, context, 0, 0, side, side);
    XFreeGC(connection.get(), context);
    XSync(connection.get(), False);
}

void exposeWindow(const std::string& display, unsigned long window) {
    const Connection connection(XOpenDisplay(display.c_str()));
    if (!connection) return;
    XClearArea(connection.get(), window, 0, 0, 0, 0, True);
    XSync(connection.get(), False);
}

void destroyWindow(const std::string& display, unsigned long window) {
    const Connection connection(XOpenDisplay(display.c_str()));
    if (!connection) return;
    XDestroyWindow(connection.get(), window);
    XSync(connection.get(), False);
}

std::string windowTitle(const std::string& display, unsigned long window) {
    const Connection connection(XOpenDisplay(display.c_str()));
    if (!connection) return {};
    XSetErrorHandler([](Display*, XErrorEvent*) { return 0; }); // the window may be gone
    const Atom name = XInternAtom(connection.get(), "_NET_WM_NAME", False);
    const Atom utf8 = XInternAtom(connection.get(), "UTF8_STRING", False);
    constexpr long kMax = 256; // words
    Atom type = kNoAtom;
    int format = 0;
    unsigned long bytes = 0, left = 0;
    unsigned char* text = nullptr;
    std::string title;
    if (XGetWindowProperty(connection.get(), window, name, 0, kMax, False, utf8, &type, &format, &bytes, &left,
                           &text) == Success &&
        text != nullptr) {
        title.assign(reinterpret_cast<const char*>(text), bytes);
        XFree(text);
    }
    return title;
}

void setDotsPerInch(const std::string& display, int dots) {
    const Connection connection(XOpenDisplay(display.c_str()));
    if (!connection) return;
    const std::string resources = "Xft.dpi:\t" + std::to_string(dots) + "\n";
    XChangeProperty(connection.get(), DefaultRootWindow(connection.get()), XA_RESOURCE_MANAGER, XA_STRING, 8,
                    PropModeReplace, reinterpret_cast<const unsigned char*>(resources.data()),
                    static_cast<int>(resources.size()));
    XSync(connection.get(), False);
}

} // namespace rt::test
