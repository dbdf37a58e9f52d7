/* SPDX-License-Identifier: Apache-2.0
 *
 * Claims of missing segments (common/constraints/insert/segment_rings.dev.h, segment_cavity.dev.h; the driver is
 * common/constraints/constraints.cpp). Memory is sequentially consistent: within a launch nobody reads what another item
 * writes, claims only fall by an atomic minimum, and the end of a launch orders all else, so that memory orders are not
 * a matter of relacy.
 *
 * Triangles are side by side around a vertex. Each item of a launch is a piece of a segment, which crosses one or two of
 * them. Which triangles, and whether there is room for its ring, is any choice, another one in each round, as what is
 * inserted divides the other pieces. Keys are in the order of the items, and grow from round to round, so that one of an
 * earlier round would come first. A round is a claim, a decision, the claims of those that go on settled, their triangles
 * written and linked, and all claims given up, a launch each. Pieces that do not go on are those of the next round.
 *
 * Checked: of pieces that meet, so share a triangle or have adjacent ones, no two go on; the lowest key among those that
 * it meets goes on, so one of each connected group; a triangle is written by one piece, linked to none that another one
 * writes, and read by nobody else in that launch; no state without a successor; and the end comes in every weakly fair run.
 *
 * check_models.py plants faults by -DSAME_KEYS, -DLOAD_AND_STORE, -DONE_SHORT, -DNO_NEIGHBORS, -DKEEP_CLAIMS,
 * -DDECIDE_AT_ONCE, -DSETTLE_AT_ONCE and -DFILL_AT_ONCE.
 */
#ifndef PIECES
#define PIECES 3
#endif
#define TRIANGLES 6
#define NONE 200    /* no claim */
#define SETTLED 100 /* the place of an edge in a ring: it may be above any key */

byte claims[TRIANGLES], written[TRIANGLES]; /* by which piece; 0: by none */
byte linked[TRIANGLES];                     /* the edge to the next triangle */
byte first[PIECES + 1], size[PIECES + 1];   /* of the triangles of a piece */
bool taken[PIECES + 1], wins[PIECES + 1];   /* there is room for its ring; it goes on */

mtype = { claim, decide, settle, fill, link, release };
mtype launch;
byte pieces, running;
bool go[PIECES + 1]; /* by process; the driver has number 0 */
bool finished;

#define TRIANGLE(k) ((first[_pid] + (k)) % TRIANGLES)
#define BEFORE TRIANGLE(TRIANGLES - 1)
#define BEHIND TRIANGLE(size[_pid])
#ifdef SAME_KEYS
#define KEY ((PIECES - pieces + _pid + 1) / 2)
#else
#define KEY (PIECES - pieces + _pid)
#endif
#ifdef ONE_SHORT
#define CLAIMED (size[_pid] == 1 -> 1 : size[_pid] - 1)
#else
#define CLAIMED size[_pid]
#endif
/* How far piece j begins behind the beginning of i, and whether they share triangles or have adjacent ones. */
#define BEHIND_OF(i, j) ((first[j] + TRIANGLES - first[i]) % TRIANGLES)
#define MEET(i, j) (BEHIND_OF(i, j) <= size[i] || BEHIND_OF(j, i) <= size[j])

inline claim_all() {
  do
  :: k < CLAIMED ->
#ifdef LOAD_AND_STORE
    seen = claims[TRIANGLE(k)];
    if
    :: seen > KEY -> claims[TRIANGLE(k)] = KEY
    :: else
    fi;
    k++
#else
    atomic { claims[TRIANGLE(k)] = (claims[TRIANGLE(k)] > KEY -> KEY : claims[TRIANGLE(k)]); k++ }
#endif
  :: else -> break
  od;
  k = 0
}

/* Its triangles are read as well: what lies beyond which edge, and which edges are constrained. */
inline decide_one() {
#ifndef NO_NEIGHBORS
  wins[_pid] = wins[_pid] && claims[BEFORE] >= KEY;
  wins[_pid] = wins[_pid] && claims[BEHIND] >= KEY;
#endif
  do
  :: k < CLAIMED ->
    atomic {
      assert(written[TRIANGLE(k)] == 0 || written[TRIANGLE(k)] == _pid);
      wins[_pid] = wins[_pid] && claims[TRIANGLE(k)] == KEY;
      k++
    }
  :: else -> break
  od;
  k = 0
}

inline settle_all() {
  do
  :: k < CLAIMED -> atomic { claims[TRIANGLE(k)] = SETTLED; k++ }
  :: else -> break
  od;
  k = 0
}

inline fill_all() {
  do
  :: k < size[_pid] -> atomic { assert(written[TRIANGLE(k)] == 0); written[TRIANGLE(k)] = _pid; k++ }
  :: else -> break
  od;
  k = 0
}

inline link_edge(edge, beyond) {
  atomic { assert(written[beyond] == 0 && linked[edge] == 0); linked[edge] = _pid }
}

inline release_all() {
  do
#ifdef KEEP_CLAIMS
  :: wins[_pid] && k < size[_pid] -> atomic { claims[TRIANGLE(k)] = NONE; k++ }
#else
  :: k < size[_pid] -> atomic { claims[TRIANGLE(k)] = NONE; k++ }
#endif
  :: else -> break
  od;
  k = 0
}

/* Pieces that are left find their ways anew. The first one always has room. The place of the first does not matter. */
inline find_pieces() {
  atomic {
    i = 1;
    do
    :: i <= pieces ->
      j = 0;
      do
      :: i > 1 && j < TRIANGLES - 1 -> j++
      :: break
      od;
      first[i] = j;
      if
      :: size[i] = 1
      :: size[i] = 2
      fi;
      if
      :: taken[i] = true
      :: i > 1 -> taken[i] = false
      fi;
      wins[i] = taken[i];
      i++
    :: else -> break
    od;
    i = 0; j = 0
  }
}

inline run_launch(kind) {
  atomic {
    launch = kind;
    i = 1;
    do
    :: i <= pieces && taken[i] -> go[i] = true; running++; i++
    :: i <= pieces && !taken[i] -> i++
    :: else -> i = 0; break
    od
  }
  running == 0
}

inline check_decisions() {
  atomic {
    i = 1;
    do
    :: i <= pieces && taken[i] ->
      lowest = true; j = 1;
      do
      :: j <= pieces && j != i && taken[j] && MEET(i, j) ->
        lowest = lowest && i < j;
        assert(!wins[i] || !wins[j]);
        j++
      :: j <= pieces && !(j != i && taken[j] && MEET(i, j)) -> j++
      :: else -> break
      od;
      assert(wins[i] || !lowest);
      i++
    :: i <= pieces && !taken[i] -> i++
    :: else -> break
    od;
    i = 0; j = 0; lowest = false
  }
}

active proctype driver() {
  byte i, j, left;
  bool lowest;
  atomic {
    do
    :: i < TRIANGLES -> claims[i] = NONE; i++
    :: else -> i = 0; break
    od;
    pieces = PIECES
  }
  do
  :: pieces > 0 ->
    find_pieces();
    run_launch(claim);
    run_launch(decide);
    check_decisions();
#ifndef SETTLE_AT_ONCE
    run_launch(settle);
#endif
#ifndef FILL_AT_ONCE
    run_launch(fill);
#endif
    run_launch(link);
    run_launch(release);
    atomic {
      left = 0; i = 1;
      do
      :: i <= pieces ->
        left = left + (wins[i] -> 0 : 1);
        wins[i] = false; taken[i] = false; first[i] = 0; size[i] = 0;
        i++
      :: else -> i = 0; break
      od;
      do
      :: i < TRIANGLES -> written[i] = 0; linked[i] = 0; i++
      :: else -> i = 0; break
      od;
      pieces = left; left = 0
    }
  :: else -> break
  od;
  finished = true
}

active [PIECES] proctype piece() {
  byte k;
#ifdef LOAD_AND_STORE
  byte seen;
#endif
end:
  do
  :: go[_pid] ->
    go[_pid] = false;
    if
    :: launch == claim ->
      claim_all();
#ifdef DECIDE_AT_ONCE
      decide_one()
#endif
    :: launch == decide ->
#ifndef DECIDE_AT_ONCE
      decide_one();
#endif
      if
#ifdef SETTLE_AT_ONCE
      :: wins[_pid] -> settle_all()
#endif
#ifdef FILL_AT_ONCE
      :: wins[_pid] -> fill_all()
#endif
      :: else
      fi
    :: launch == settle && wins[_pid] -> settle_all()
    :: launch == fill && wins[_pid] -> fill_all()
    :: launch == link && wins[_pid] -> link_edge(BEFORE, BEFORE); link_edge(TRIANGLE(size[_pid] - 1), BEHIND)
    :: launch == release -> release_all()
    :: else
    fi;
    running--
  od
}

ltl ends { <> finished }
