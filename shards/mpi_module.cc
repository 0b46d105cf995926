// SPDX-License-Identifier: GPL-3.0-or-later
#include <mpi.h>

#include <algorithm>
#include <list>
#include <vector>

#include "shards/mpi_interface.h"

namespace {

/// A message that MPI may still be reading.
struct Sending {
  std::vector<char> bytes;
  MPI_Request request = MPI_REQUEST_NULL;
};

constexpr int kTag = 1;

std::list<Sending>& sending() {
  static std::list<Sending> all;
  return all;
}

/// Forgets what was sent.
void forget() {
  sending().remove_if([](Sending& message) {
    int is_done = 0;
    return MPI_Test(&message.request, &is_done, MPI_STATUS_IGNORE) != MPI_SUCCESS || is_done != 0;
  });
}

}  // namespace

extern "C" {

int taut_mpi_begin(int* rank, int* size) {
  int provided = 0;
  if (const int error = MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided); error != MPI_SUCCESS) {
    return error;
  }
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  MPI_Comm_rank(MPI_COMM_WORLD, rank);
  MPI_Comm_size(MPI_COMM_WORLD, size);
  return MPI_SUCCESS;
}

int taut_mpi_send(int to, const char* bytes, size_t count) {
  forget();
  Sending& message = sending().emplace_back();
  message.bytes.assign(bytes, bytes + count);
  return MPI_Isend(message.bytes.data(), static_cast<int>(count), MPI_BYTE, to, kTag, MPI_COMM_WORLD, &message.request);
}

int taut_mpi_receive(int* from, char* bytes) {
  int is_there = 0;
  MPI_Status status;
  if (MPI_Iprobe(MPI_ANY_SOURCE, kTag, MPI_COMM_WORLD, &is_there, &status) != MPI_SUCCESS) return -1;
  if (is_there == 0) return 0;
  if (MPI_Recv(bytes, TAUT_MPI_MOST_BYTES, MPI_BYTE, status.MPI_SOURCE, kTag, MPI_COMM_WORLD, &status) != MPI_SUCCESS) {
    return -1;
  }
  int count = 0;
  MPI_Get_count(&status, MPI_BYTE, &count);
  *from = status.MPI_SOURCE;
  return count;
}

void taut_mpi_end(void) {
  for (Sending& message : sending()) MPI_Wait(&message.request, MPI_STATUS_IGNORE);
  sending().clear();
  MPI_Finalize();
}

}  // extern "C"
