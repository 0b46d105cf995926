// SPDX-License-Identifier: GPL-3.0-or-later
// Processes that mpirun started, on one machine or many. Rank 0 deals tasks, also to itself, and takes the results;
// each rank computes one task at a time. A rank that dies, or is not heard of for kMostSilence, gets no more tasks, and
// those that it had are dealt again.
//
// MPI is a module, libtaut_mpi.so, which is loaded by join(): taut runs without it.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "shards/dealing.h"

namespace taut {

class Ranks {
 public:
  static constexpr std::chrono::seconds kMostSilence{60};

  /// Joins the other processes, if mpirun or a like program started this one; else returns nothing.
  /// @param say  takes messages for the user: of a rank that died
  /// @throws InputError where there is no module, or it is made for another MPI than mpirun is of
  [[nodiscard]] static std::unique_ptr<Ranks> join(std::function<void(const std::string&)> say);

  /// Of rank 0: lets the others go. All of them: ends MPI, unless a rank has died, which MPI would wait for. Where
  /// rank 0 fell silent, ends at once.
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  [[nodiscard]] bool is_first() const;
  [[nodiscard]] std::size_t size() const;

  /// Rank 0: has all tasks computed, the first one first, as deal_to_threads() does. Ranks are left out until they say
  /// that they compute the same work.
  /// @throws InputError where a rank could not begin, or computes other work
  void deal(const std::string& work, const std::vector<Task>& tasks, const RunTask& run, const TaskDone& done,
            const std::stop_token& stop);

  /// Other ranks: computes what rank 0 deals, until it lets them go or is not heard of for kMostSilence, which is said.
  /// @param work  the digest of all that determines results
  void serve(const std::string& work, const RunTask& run, const std::stop_token& stop);

  /// Other ranks: tells rank 0 why this one can't compute anything, which then says so.
  void fail(const std::string& message);

 private:
  class Network;
  class FirstRank;
  class OtherRank;

  explicit Ranks(std::unique_ptr<Network> network, std::function<void(const std::string&)> say);

  std::unique_ptr<Network> network_;
  std::function<void(const std::string&)> say_;
  std::unique_ptr<FirstRank> first_;  ///< on rank 0
  bool is_awaited_ = true;            ///< on other ranks: rank 0 waits for this one to end
};

}  // namespace taut
