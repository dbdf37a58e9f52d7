/* SPDX-License-Identifier: Apache-2.0
 *
 * Lock, requeue and legality sweep of the insertion (common/insertion/lock.dev.h, insert.dev.h, legality_sweep.dev.h; the driver is
 * common/insertion/insertion.cpp) with sequentially consistent memory. Memory orders are the subject of
 * protocol_test.cpp beside this.
 *
 * Items are points and edges. Each needs three of the triangles. A worker that inserts point p makes edge p illegal and
 * must check it; it tries the edge at once, and after TRIES failed try-locks, or if the worklist is full, defers it to the
 * next launch; if that list is full, too, the edge is dropped and only a legality sweep can find it. Points are never
 * dropped.
 *
 * Checked: triangles are held by one worker at a time; what was read before a lock is true after it; at the end all
 * locks are free, each point was inserted once and no edge is illegal; no state without a successor; and the end comes
 * in every weakly fair run.
 *
 * check_models.py plants faults by -DHOLD_AND_WAIT, -DDROP_POINT, -DNO_REREAD, -DONE_PASS, -DKEEP_LOCK, -DUNSORTED and
 * -DNO_FALLBACK. Locks in no order (UNSORTED) are no fault by themselves: the worker that is alone in the end makes
 * progress.
 */
#ifndef WORKERS
#define WORKERS 2
#endif
#define RECORDS 4
#ifndef POINTS
#define POINTS 3
#endif
#define ITEMS (2 * POINTS) /* points and their edges */
#define TRIES 1
#define ROOM 1   /* of the list of edges */
#define PATIENCE 2 /* launches without progress, then one worker is alone */

byte holder[RECORDS];  /* 0: free */
byte version[RECORDS]; /* how often a triangle has changed */
byte needs[18];        /* the triangles of an item, in the order of locks */
bool inserted[POINTS], illegal[POINTS];

byte work[ITEMS], work_size;          /* of this launch */
byte deferred_points[POINTS], deferred_edges[ROOM], points_left, edges_left;
byte cursor, running, crew;           /* crew: workers of this launch */
bool go[WORKERS + 1];                 /* by process; the driver has number 0 */
bool closing, changed, found, finished;

#define NEED(item, k) needs[((item) < POINTS -> (item) : 3 + (item) - POINTS) * 3 + (k)]
#define LOWEST(item) NEED(item, 0)

/* Locks the three triangles of `item`; `won`: whether that was possible. */
inline try_claim(item) {
  k = 0;
  do
  :: k == 3 -> won = true; break
  :: k < 3 ->
    atomic {
      r = NEED(item, k);
#ifdef NO_REREAD
      if
      :: holder[r] == 0 -> holder[r] = _pid; k++
#else
      if
      :: holder[r] == 0 && (r != LOWEST(item) || version[r] == seen) -> holder[r] = _pid; k++
#endif
#ifdef HOLD_AND_WAIT
      :: holder[r] != 0 -> skip
      :: holder[r] == 0 && r == LOWEST(item) && version[r] != seen -> won = false; break
#else
      :: else -> won = false; break
#endif
      fi
    }
#ifdef HOLD_AND_WAIT
    if
    :: k < 3 && holder[NEED(item, k)] != 0 -> holder[NEED(item, k)] == 0
    :: else
    fi
#endif
  od;
  if
  :: !won ->
    do
#ifdef KEEP_LOCK
    :: k > 1 -> k--; holder[NEED(item, k)] = 0
    :: k <= 1 -> k = 0; break
#else
    :: k > 0 -> k--; holder[NEED(item, k)] = 0
    :: k == 0 -> break
#endif
    od
  :: else
  fi
}

/* Reads, locks, changes and unlocks. \post done */
inline attempt(item) {
  done = false;
  atomic { r = LOWEST(item); seen = version[r]; won = false }
  if
  :: item >= POINTS && !illegal[item - POINTS] -> done = true /* somebody has done it */
  :: else ->
    try_claim(item);
    if
    :: won ->
      assert(version[LOWEST(item)] == seen);
      k = 0;
      do
      :: k < 3 ->
        assert(holder[NEED(item, k)] == _pid);
        version[NEED(item, k)]++;
        k++
      :: k == 3 -> break
      od;
      atomic {
        if
        :: item < POINTS ->
          assert(!inserted[item]);
          inserted[item] = true;
          illegal[item] = true
        :: else -> illegal[item - POINTS] = false
        fi;
        changed = true
      }
      do
      :: k > 0 -> k--; assert(holder[NEED(item, k)] == _pid); holder[NEED(item, k)] = 0
      :: k == 0 -> break
      od;
      done = true
    :: else
    fi
  fi
}

inline attempt_some(item) {
  tries = 0;
  do
  :: attempt(item);
    tries++;
    if
    :: done || tries > TRIES -> break
    :: else
    fi
  od
}

/* To the next launch. */
inline requeue(item) {
  atomic {
    if
    :: item < POINTS ->
#ifndef DROP_POINT
      deferred_points[points_left] = item;
      points_left++
#else
      skip
#endif
    :: item >= POINTS && edges_left < ROOM -> deferred_edges[edges_left] = item; edges_left++
    :: else /* a legality sweep will find it */
    fi
  }
}

active proctype driver() {
  byte i, stalled;
  atomic {
    needs[0] = 0; needs[1] = 1; needs[2] = 2;
    needs[3] = 1; needs[4] = 2; needs[5] = 3;
    needs[6] = 0; needs[7] = 2; needs[8] = 3;
    needs[9] = 0; needs[10] = 1; needs[11] = 3;
    needs[12] = 0; needs[13] = 2; needs[14] = 3;
    needs[15] = 1; needs[16] = 2; needs[17] = 3;
#ifdef UNSORTED
    needs[3] = 3; needs[5] = 1;
    needs[12] = 3; needs[14] = 0;
#endif
    do
    :: i < POINTS -> work[i] = i; i++
    :: else -> work_size = i; i = 0; break
    od
  }
  do
  :: true -> /* one launch */
    atomic {
      cursor = 0; changed = false; found = false;
#ifdef NO_FALLBACK
      crew = WORKERS;
#else
      crew = (stalled >= PATIENCE -> 1 : WORKERS);
#endif
      running = crew;
      i = 1;
      do
      :: i <= crew -> go[i] = true; i++
      :: else -> i = 0; break
      od
    }
    running == 0;
    atomic {
      stalled = (changed || closing -> 0 : (stalled < PATIENCE -> stalled + 1 : stalled));
      work_size = 0; i = 0;
      do
      :: i < points_left -> work[work_size] = deferred_points[i]; work_size++; i++
      :: else -> break
      od;
      i = 0;
      do
      :: i < edges_left -> work[work_size] = deferred_edges[i]; work_size++; i++
      :: else -> break
      od;
      i = 0; points_left = 0; edges_left = 0
    }
    if
    :: work_size > 0 -> closing = false
#ifdef ONE_PASS
    :: work_size == 0 && closing -> break
#else
    :: work_size == 0 && closing && !found -> break
    :: work_size == 0 && closing && found -> work_size = POINTS
#endif
    :: work_size == 0 && !closing -> closing = true; work_size = POINTS
    fi
  od;
  i = 0;
  do
  :: i < RECORDS -> assert(holder[i] == 0); i++
  :: else -> break
  od;
  i = 0;
  do
  :: i < POINTS -> assert(inserted[i] && !illegal[i]); i++
  :: else -> break
  od;
  i = 0;
  finished = true
}

active [WORKERS] proctype worker() {
  byte at, item, k, r, seen, tries;
  bool won, done;
end:
  do
  :: go[_pid] ->
    go[_pid] = false;
    do
    :: atomic { at = cursor; cursor++ }
      if
      :: at >= work_size -> break
      :: else
      fi;
      if
      :: closing ->
        item = POINTS + at;
        if /* held: it is looked at in another pass */
        :: holder[NEED(item, 0)] != 0 || holder[NEED(item, 1)] != 0 -> found = true
        :: else ->
          if
          :: illegal[at] ->
            found = true;
            attempt_some(item);
            if
            :: !done -> requeue(item)
            :: else
            fi
          :: else
          fi
        fi
      :: else ->
        item = work[at];
        attempt_some(item);
        if
        :: !done -> requeue(item)
        :: done && item < POINTS ->
          item = item + POINTS; /* the edge that may have become illegal */
          attempt_some(item);
          if
          :: !done -> requeue(item)
          :: else
          fi
        :: else
        fi
      fi
    od;
    atomic { at = 0; item = 0; k = 0; r = 0; seen = 0; tries = 0; won = false; done = false; running-- }
  od
}

ltl ends { <> finished }
