// The rank that rank 0 is itself: its engine, on a thread of its own.
#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "Common/App/Ranks/RankWorker.h"

namespace rt::app {

// Messages from one thread to another.
class MessageQueue {
  public:
    void put(Message message) {
        const std::scoped_lock lock(mutex_);
        messages_.push_back(std::move(message));
    }
    std::optional<Message> take() {
        const std::scoped_lock lock(mutex_);
        if (messages_.empty()) return std::nullopt;
        std::optional<Message> message = std::move(messages_.front());
        messages_.pop_front();
        return message;
    }

  private:
    std::mutex mutex_;
    std::deque<Message> messages_;
};

// The engine, which has its scene, must be left alone while this exists.
class LocalRank {
  public:
    LocalRank(Engine& engine, const scene::CompiledScene& scene, const RenderSettings& settings)
        : link_{[this](Message message) { outbox_.put(std::move(message)); }, [this] { return inbox_.take(); }},
          thread_([this, &engine, &scene, settings] { serve(engine, scene, settings); }) {}
    ~LocalRank() {
        inbox_.put({MessageKind::End, nullptr, {}});
        thread_.join();
    }
    LocalRank(const LocalRank&) = delete;
    LocalRank& operator=(const LocalRank&) = delete;

    void send(Message message) { inbox_.put(std::move(message)); }
    std::optional<Message> receive() { return outbox_.take(); }

  private:
    void serve(Engine& engine, const scene::CompiledScene& scene, const RenderSettings& settings) {
        try {
            serveLeases(engine, scene, settings, link_);
        } catch (const std::exception& error) {
            outbox_.put(failureMessage(error));
        }
    }

    MessageQueue inbox_, outbox_;
    RankLink link_;
    std::thread thread_;
};

} // namespace rt::app
