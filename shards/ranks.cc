// SPDX-License-Identifier: GPL-3.0-or-later
#include "shards/ranks.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <utility>

#include "base/input_error.h"
#include "shards/mpi_interface.h"

namespace taut {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

/// How long a rank that has nothing to send or receive sleeps: waiting takes no processor.
constexpr auto kNap = 500us;
constexpr auto kBetweenBeats = 1s;

/// What a message is about: its first byte.
enum class Word : char {
  kHello = 'h',   ///< to rank 0: the digest of the work, the host, the process
  kFailed = 'f',  ///< to rank 0: why nothing can be computed
  kTask = 't',    ///< from rank 0
  kResult = 'r',  ///< to rank 0
  kBeat = 'b',    ///< both ways: still there
  kEnd = 'e',     ///< from rank 0: no more tasks
  kBye = 'y',     ///< to rank 0: nothing runs any more
  kFinish = 'm',  ///< from rank 0: all live; end MPI together
  kLeave = 'l',   ///< from rank 0: a rank has died; leave without
};

void append_number(std::string& bytes, std::uint64_t value) {
  for (int n = 0; n < 8; ++n) bytes += static_cast<char>((value >> (8 * n)) & 0xFFU);
}

std::uint64_t number_at(const std::string& bytes, std::size_t at) {
  std::uint64_t value = 0;
  for (std::size_t n = 0; n < 8; ++n) value |= std::uint64_t{static_cast<unsigned char>(bytes.at(at + n))} << (8 * n);
  return value;
}

/// How many processes were started together, as the environment tells; 0 where this one was started alone.
int started_together() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const char* const text = std::getenv(name);
    int count = 0;
    if (text != nullptr && std::from_chars(text, text + std::strlen(text), count).ec == std::errc() && count > 0) {
      return count;
    }
  }
  if (std::getenv("PMIX_RANK") == nullptr) return 0;
  const char* const text = std::getenv("SLURM_STEP_NUM_TASKS");
  int count = 0;
  if (text != nullptr) std::from_chars(text, text + std::strlen(text), count);
  return std::max(count, 0);
}

/// The module: where the program is installed, else where it was built.
std::filesystem::path module_path() {
  std::error_code ignored;
  const std::filesystem::path here = std::filesystem::canonical("/proc/self/exe", ignored).parent_path();
  for (const std::filesystem::path& path :
       {here / "../lib/taut/libtaut_mpi.so", here / "../shards/libtaut_mpi.so", here / "../../shards/libtaut_mpi.so"}) {
    if (std::filesystem::exists(path, ignored)) return path;
  }
  return {};
}

}  // namespace

// ---- Messages -------------------------------------------------------------------------------------------------------

class Ranks::Network {
 public:
  Network(void* module, int expected) {
    load(module, "taut_mpi_begin", begin_);
    load(module, "taut_mpi_send", send_);
    load(module, "taut_mpi_receive", receive_);
    load(module, "taut_mpi_end", end_);
    if (begin_(&rank_, &size_) != 0) throw InputError(ErrorCode::kUse, "mpirun: MPI could not be started");
    if (size_ != expected) {
      throw InputError(ErrorCode::kUse,
                       fmt::format("mpirun: it started {} processes, and the MPI of libtaut_mpi.so sees {}; expected "
                                   "the mpirun of that MPI",
                                   expected, size_));
    }
    arrived_.resize(static_cast<std::size_t>(size_));
  }

  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int size() const { return size_; }
  void end() { end_(); }

  /// @returns false where MPI can't send to this rank.
  bool send(int to, Word word, const std::string& content = "") {
    std::string bytes;
    append_number(bytes, content.size() + 1);
    bytes += static_cast<char>(word);
    bytes += content;
    for (std::size_t at = 0; at < bytes.size(); at += TAUT_MPI_MOST_BYTES) {
      const std::size_t count = std::min<std::size_t>(TAUT_MPI_MOST_BYTES, bytes.size() - at);
      if (send_(to, bytes.data() + at, count) != 0) return false;
    }
    return true;
  }

  struct Message {
    int from = 0;
    Word word = Word::kBeat;
    std::string content;
  };

  /// The next message that is complete, if any.
  std::optional<Message> receive() {
    std::array<char, TAUT_MPI_MOST_BYTES> piece;
    for (int from = 0, count = 0; (count = receive_(&from, piece.data())) > 0;) {
      std::string& bytes = arrived_.at(static_cast<std::size_t>(from));
      bytes.append(piece.data(), static_cast<std::size_t>(count));
      if (bytes.size() < 9 || bytes.size() < 8 + number_at(bytes, 0)) continue;
      Message message{from, static_cast<Word>(bytes[8]), bytes.substr(9)};
      bytes.clear();  // a message begins in a piece of its own
      return message;
    }
    return std::nullopt;
  }

 private:
  template <class Function>
  static void load(void* module, const char* name, Function*& function) {
    function = reinterpret_cast<Function*>(dlsym(module, name));
    if (function == nullptr) {
      throw InputError(ErrorCode::kUse,
                       fmt::format("mpirun: libtaut_mpi.so has no {}; expected that of this taut", name));
    }
  }

  int (*begin_)(int*, int*) = nullptr;
  int (*send_)(int, const char*, size_t) = nullptr;
  int (*receive_)(int*, char*) = nullptr;
  void (*end_)() = nullptr;
  int rank_ = 0;
  int size_ = 1;
  std::vector<std::string> arrived_;  ///< by rank: the pieces of a message that is not complete
};

// ---- Rank 0 ---------------------------------------------------------------------------------------------------------

class Ranks::FirstRank {
 public:
  FirstRank(Network& network, const std::function<void(const std::string&)>& say)
      : network_(network), say_(say), others_(static_cast<std::size_t>(network.size())) {}

  void deal(const std::string& work, const std::vector<Task>& tasks, const RunTask& run, const TaskDone& done,
            const std::stop_token& stop) {
    begin_round(work, tasks, done);
    std::jthread own([&] { compute(run); });
    try {
      while (done_count_ < tasks.size() && !stop.stop_requested()) {
        if (!poll()) std::this_thread::sleep_for(kNap);
      }
    } catch (...) {
      end_round();
      own.join();
      throw;
    }
    end_round();
  }

  /// Lets all go. @returns whether all are still there, and wait for the end of MPI.
  bool let_go() {
    for (int rank = 1; rank < network_.size(); ++rank) network_.send(rank, Word::kEnd);
    const auto begin = Clock::now();
    const auto is_waiting = [](const Other& other) { return !other.is_lost && !other.has_left; };
    while (std::any_of(others_.begin() + 1, others_.end(), is_waiting)) {
      if (Clock::now() - begin > 2 * kMostSilence) break;
      if (!receive_all()) std::this_thread::sleep_for(kNap);
      look_for_the_lost();
    }
    const bool do_all_live =
        std::none_of(others_.begin() + 1, others_.end(), [](const Other& other) { return !other.has_left; });
    for (int rank = 1; rank < network_.size(); ++rank) {
      network_.send(rank, do_all_live ? Word::kFinish : Word::kLeave);
    }
    return do_all_live;
  }

 private:
  struct Other {
    bool is_ready = false;  ///< it computes the same work
    bool is_lost = false;
    bool has_left = false;
    std::string host = "an unknown host";
    std::string work;
    int process = 0;
    bool is_here = false;  ///< on this machine
    Clock::time_point heard = Clock::now();
    std::vector<std::size_t> tasks;  ///< that it was dealt
  };

  void begin_round(const std::string& work, const std::vector<Task>& tasks, const TaskDone& done) {
    const std::lock_guard lock(mutex_);
    ++round_;
    work_ = work;
    tasks_ = &tasks;
    done_ = &done;
    is_done_.assign(tasks.size(), 0);
    done_count_ = 0;
    failure_ = nullptr;
    queue_.clear();
    for (std::size_t task = 0; task < tasks.size(); ++task) queue_.push_back(task);
    for (Other& other : others_) {
      other.tasks.clear();
      other.heard = Clock::now();
    }
    for (std::size_t rank = 1; rank < others_.size(); ++rank) {
      if (others_[rank].is_ready) require_same_work(rank);
    }
    is_open_ = true;
  }

  void end_round() {
    const std::lock_guard lock(mutex_);
    is_open_ = false;
    queue_.clear();
  }

  /// One look at all that may have happened. @returns whether anything had.
  bool poll() {
    bool was_busy = receive_all();
    look_for_the_lost();
    was_busy = hand_out() || was_busy;
    std::deque<std::pair<std::size_t, std::string>> own;
    {
      const std::lock_guard lock(mutex_);
      if (failure_) std::rethrow_exception(failure_);
      own.swap(own_results_);
    }
    for (auto& [task, result] : own) take(task, std::move(result));
    return was_busy || !own.empty();
  }

  /// Rank 0's own share of the tasks, on a thread of its own.
  void compute(const RunTask& run) {
    for (;;) {
      std::size_t task = 0;
      {
        const std::lock_guard lock(mutex_);
        if (!is_open_) return;
        if (!queue_.empty()) {
          task = queue_.front();
          queue_.pop_front();
        } else {
          task = tasks_->size();
        }
      }
      if (task == tasks_->size()) {
        std::this_thread::sleep_for(kNap);  // a rank may die yet
        continue;
      }
      try {
        std::string result = run((*tasks_)[task]);
        const std::lock_guard lock(mutex_);
        own_results_.emplace_back(task, std::move(result));
      } catch (...) {
        const std::lock_guard lock(mutex_);
        failure_ = std::current_exception();
        return;
      }
    }
  }

  /// Gives tasks to ranks, so that each has one to compute and one to go on with; more of them while many are left,
  /// because small tasks take less time than a nap.
  bool hand_out() {
    constexpr std::size_t kLeast = 2, kMost = 32, kShare = 8;
    const std::size_t most_tasks =
        std::clamp((tasks_->size() - done_count_) / (kShare * others_.size()), kLeast, kMost);
    bool has_dealt = false;
    for (std::size_t rank = 1; rank < others_.size(); ++rank) {
      Other& other = others_[rank];
      while (other.is_ready && !other.is_lost && other.tasks.size() < most_tasks) {
        std::size_t task = 0;
        {
          const std::lock_guard lock(mutex_);
          if (queue_.empty()) return has_dealt;
          task = queue_.front();
          queue_.pop_front();
        }
        other.tasks.push_back(task);
        has_dealt = true;
        std::string content;
        for (const std::uint64_t value : {round_, std::uint64_t{task}, std::uint64_t{(*tasks_)[task].part}}) {
          append_number(content, value);
        }
        if (!network_.send(static_cast<int>(rank), Word::kTask, content + (*tasks_)[task].input)) {
          lose(rank, "MPI could not send to it");
        }
      }
    }
    return has_dealt;
  }

  bool receive_all() {
    bool has_any = false;
    while (auto message = network_.receive()) {
      has_any = true;
      Other& other = others_.at(static_cast<std::size_t>(message->from));
      other.heard = Clock::now();
      switch (message->word) {
        case Word::kHello: greet(static_cast<std::size_t>(message->from), message->content); break;
        case Word::kResult: take_from(other, message->content); break;
        case Word::kBye: other.has_left = true; break;
        case Word::kFailed:
          if (is_open_) {
            throw InputError(fmt::format("rank {} of {}: {}", message->from, network_.size(), message->content));
          }
          break;
        default: break;
      }
    }
    return has_any;
  }

  void greet(std::size_t rank, const std::string& content) {
    const auto hello = nlohmann::json::parse(content);
    Other& other = others_[rank];
    other.host = hello.at("host");
    other.work = hello.at("work");
    other.process = hello.at("process");
    std::array<char, 256> own_host{};
    other.is_here = gethostname(own_host.data(), own_host.size() - 1) == 0 && other.host == own_host.data() &&
                    kill(other.process, 0) == 0;
    if (is_open_) require_same_work(rank);
    other.is_ready = true;
  }

  void require_same_work(std::size_t rank) const {
    if (others_[rank].work == work_) return;
    throw InputError(ErrorCode::kUse,
                     fmt::format("mpirun: rank {} on {} computes other work than rank 0; expected the same taut, case "
                                 "and options on all machines",
                                 rank, others_[rank].host));
  }

  void take_from(Other& other, std::string& content) {
    const std::uint64_t round = number_at(content, 0);
    const auto task = static_cast<std::size_t>(number_at(content, 8));
    if (round != round_ || !is_open_) return;  // of a rank that was thought dead
    std::erase(other.tasks, task);
    take(task, content.substr(16));
  }

  void take(std::size_t task, std::string result) {
    if (is_done_.at(task) != 0) return;
    is_done_[task] = 1;
    ++done_count_;
    (*done_)(task, std::move(result));
  }

  void look_for_the_lost() {
    const auto now = Clock::now();
    for (std::size_t rank = 1; rank < others_.size(); ++rank) {
      Other& other = others_[rank];
      if (other.is_lost || other.has_left) continue;
      if (other.is_here && other.process > 0 && kill(other.process, 0) != 0 && errno == ESRCH) {
        lose(rank, "its process ended");
      } else if (now - other.heard > kMostSilence) {
        lose(rank, fmt::format("it was not heard of for {} s", kMostSilence.count()));
      }
    }
    if (now - last_beat_ < kBetweenBeats) return;
    last_beat_ = now;
    for (std::size_t rank = 1; rank < others_.size(); ++rank) {
      if (!others_[rank].is_lost) network_.send(static_cast<int>(rank), Word::kBeat);
    }
  }

  void lose(std::size_t rank, const std::string& reason) {
    Other& other = others_[rank];
    other.is_lost = true;
    const std::lock_guard lock(mutex_);
    std::size_t again = 0;
    for (const std::size_t task : other.tasks) {
      if (is_open_ && is_done_.at(task) == 0) {
        queue_.push_front(task);
        ++again;
      }
    }
    other.tasks.clear();
    say_(
        fmt::format("rank {} on {} is lost, because {}; {} of its parts dealt again", rank, other.host, reason, again));
  }

  Network& network_;
  const std::function<void(const std::string&)>& say_;
  std::vector<Other> others_;  ///< by rank; 0 is not used
  std::string work_;
  std::uint64_t round_ = 0;
  const std::vector<Task>* tasks_ = nullptr;
  const TaskDone* done_ = nullptr;
  std::vector<char> is_done_;
  std::size_t done_count_ = 0;
  Clock::time_point last_beat_ = Clock::now();
  // Shared with the thread that computes:
  std::mutex mutex_;
  bool is_open_ = false;
  std::deque<std::size_t> queue_;  ///< tasks that nobody has
  std::deque<std::pair<std::size_t, std::string>> own_results_;
  std::exception_ptr failure_;
};

// ---- Other ranks ----------------------------------------------------------------------------------------------------

class Ranks::OtherRank {
 public:
  enum class End {
    kLetGo,      ///< rank 0 waits for this one
    kLeftAlone,  ///< it does not
    kSilence,    ///< it was not heard of for kMostSilence
  };

  OtherRank(Network& network, const RunTask& run) : network_(network), run_(run) {}

  End serve(const std::stop_token& stop) {
    bool is_silent = false;
    std::jthread computing([this](const std::stop_token& end) { compute(end); });
    while (!is_over_ && !stop.stop_requested()) {
      const bool was_busy = receive_all();
      if (!send_results() && !was_busy) std::this_thread::sleep_for(kNap);
      const auto now = Clock::now();
      is_silent = now - heard_ > kMostSilence;
      if (is_silent) break;
      if (now - last_beat_ < kBetweenBeats) continue;
      last_beat_ = now;
      network_.send(0, Word::kBeat);
    }
    computing.request_stop();
    changed_.notify_all();
    if (is_silent) return End::kSilence;
    return is_left_alone_ ? End::kLeftAlone : End::kLetGo;
  }

 private:
  struct Assignment {
    std::string key;  ///< the round and the task, as rank 0 names them
    Task task;
  };

  void compute(const std::stop_token& end) {
    for (;;) {
      Assignment assignment;
      {
        std::unique_lock lock(mutex_);
        if (!changed_.wait(lock, end, [&] { return !assignments_.empty(); })) return;
        assignment = std::move(assignments_.front());
        assignments_.pop_front();
      }
      std::pair<Word, std::string> result{Word::kResult, assignment.key};
      try {
        result.second += run_(assignment.task);
      } catch (const std::exception& error) {
        result = {Word::kFailed, error.what()};
      }
      const std::lock_guard lock(mutex_);
      results_.push_back(std::move(result));
    }
  }

  bool send_results() {
    std::deque<std::pair<Word, std::string>> results;
    {
      const std::lock_guard lock(mutex_);
      results.swap(results_);
    }
    for (const auto& [word, content] : results) network_.send(0, word, content);
    return !results.empty();
  }

  bool receive_all() {
    bool has_any = false;
    while (auto message = network_.receive()) {
      has_any = true;
      heard_ = Clock::now();
      if (message->word == Word::kEnd) is_over_ = true;
      if (message->word == Word::kLeave) is_over_ = is_left_alone_ = true;  // this one was thought dead
      if (message->word != Word::kTask) continue;
      const std::string& content = message->content;
      const std::lock_guard lock(mutex_);
      assignments_.push_back(
          {content.substr(0, 16), {static_cast<std::size_t>(number_at(content, 16)), content.substr(24)}});
      changed_.notify_one();
    }
    return has_any;
  }

  Network& network_;
  const RunTask& run_;
  bool is_over_ = false, is_left_alone_ = false;
  Clock::time_point heard_ = Clock::now(), last_beat_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Assignment> assignments_;
  std::deque<std::pair<Word, std::string>> results_;
};

// ---- All ranks ------------------------------------------------------------------------------------------------------

std::unique_ptr<Ranks> Ranks::join(std::function<void(const std::string&)> say) {
  const int count = started_together();
  if (count == 0) return nullptr;
  const std::filesystem::path path = module_path();
  void* const module = path.empty() ? nullptr : dlopen(path.c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (module == nullptr) {
    const char* const reason = path.empty() ? "this taut was built or installed without libtaut_mpi.so" : dlerror();
    throw InputError(ErrorCode::kUse,
                     fmt::format("mpirun: got {} processes, and {}; expected the package openmpi-bin and a taut with "
                                 "the module, or --shard k/m, which needs no MPI",
                                 count, reason == nullptr ? "an unknown reason" : reason));
  }
  return std::unique_ptr<Ranks>(new Ranks(std::make_unique<Network>(module, count), std::move(say)));
}

Ranks::Ranks(std::unique_ptr<Network> network, std::function<void(const std::string&)> say)
    : network_(std::move(network)), say_(std::move(say)) {
  if (is_first()) first_ = std::make_unique<FirstRank>(*network_, say_);
}

Ranks::~Ranks() {
  try {
    if (first_) {
      if (first_->let_go()) network_->end();
      return;
    }
    if (!is_awaited_) return;
    network_->send(0, Word::kBye);
    const auto begin = Clock::now();
    while (Clock::now() - begin < 4 * kMostSilence) {
      const auto message = network_->receive();
      if (message && message->word == Word::kFinish) network_->end();
      if (message && (message->word == Word::kFinish || message->word == Word::kLeave)) return;
      if (!message) std::this_thread::sleep_for(kNap);
    }
  } catch (const std::exception& error) {
    say_(fmt::format("MPI could not be ended: {}", error.what()));
  }
}

bool Ranks::is_first() const { return network_->rank() == 0; }
std::size_t Ranks::size() const { return static_cast<std::size_t>(network_->size()); }

void Ranks::deal(const std::string& work, const std::vector<Task>& tasks, const RunTask& run, const TaskDone& done,
                 const std::stop_token& stop) {
  first_->deal(work, tasks, run, done, stop);
}

void Ranks::serve(const std::string& work, const RunTask& run, const std::stop_token& stop) {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  const nlohmann::json hello = {{"host", host.data()}, {"process", getpid()}, {"work", work}};
  network_->send(0, Word::kHello, hello.dump());
  const OtherRank::End end = OtherRank(*network_, run).serve(stop);
  is_awaited_ = end == OtherRank::End::kLetGo;
  if (end != OtherRank::End::kSilence) return;
  say_(fmt::format("rank {} on {} ends, because rank 0 was not heard of for {} s", network_->rank(), host.data(),
                   kMostSilence.count()));
}

void Ranks::fail(const std::string& message) { network_->send(0, Word::kFailed, message); }

}  // namespace taut
