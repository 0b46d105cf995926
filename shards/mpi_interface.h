/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What libtaut_mpi.so offers to taut, which loads it where mpirun starts it. Only one thread calls it. */
#pragma once

#include <stddef.h>

/* The most bytes of one message: MPI sends so few without waiting for the receiver, who may have died. */
#define TAUT_MPI_MOST_BYTES 4000

#ifdef __cplusplus
extern "C" {
#endif

/* Joins the other processes. Returns 0, or MPI's error. */
int taut_mpi_begin(int* rank, int* size);
/* Sends at most TAUT_MPI_MOST_BYTES. The bytes are copied. Messages between two ranks arrive in order. Returns 0, or
 * MPI's error. */
int taut_mpi_send(int to, const char* bytes, size_t count);
/* Receives a message that has arrived, of at most TAUT_MPI_MOST_BYTES. Returns how many bytes it has; 0 where there is
 * none, and -1 where MPI failed. */
int taut_mpi_receive(int* from, char* bytes);
/* Ends MPI together with all other ranks, none of which may have died. */
void taut_mpi_end(void);

#ifdef __cplusplus
}
#endif
