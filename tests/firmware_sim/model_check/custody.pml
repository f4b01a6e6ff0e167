/* The custody protocol once more, from its specification (docs/reliability.md, 2.5 and 2.6) and not from the code:
 * nodes, their records in memory, their jaws, and the network as the set of facts ever said, any of which may be
 * heard at any time or never. Power cuts come at any moment, hosts ask for anything. custody_twin.py has `spin`
 * search it whole, as it is and with one rule left out at a time (-DNO_R1 ...).
 *
 * I2 and I2b are asserted after every change, R6 where jaws open. I2c: at any moment the adversary may give up (`calm`); from there
 * a fixed, cooperative order of moves, with every older frame lost, must reach rest.
 *
 * Promises: I2, I2b, I2c.
 */

#ifndef NODES
#define NODES 3
#endif
#ifndef TOKENS
#define TOKENS 1
#endif
#define AT(giver, token) ((giver) * TOKENS + (token) - 1)
#define PAIR(one, other) ((one) * NODES + (other))

mtype:state = { IDLE, SEATED, SQUEEZING, TAKEN, HOLD, OFFERED, RELAX, RESQUEEZE, OPENING, STRANDED };
mtype:record = { EMPTY, SOLE, OFFER_OUT, LATCHED, DECIDED, RELEASED, RETAINED };
mtype:grip = { OPEN, LIGHT, FULL };

/* What a node believes, and what its memory holds. */
typedef Record {
  mtype:record kind;
  byte peer;
  byte token;
  byte number;              /* tokens given out */
  byte last[NODES];         /* newest token of each giver */
  byte outcome[TOKENS];     /* of own tokens: 0 none, 1 released, 2 retained */
  byte receiver[TOKENS]     /* to whom they were offered */
}

mtype:state st[NODES];
mtype:grip grip[NODES];
Record ram[NODES], nvm[NODES];
bool storing[NODES];        /* ram is on its way to nvm */
bool proven[NODES];         /* the hold was stable since power came */
bool freed[NODES];          /* the giver was heard to retain */
bool retain_said[NODES];    /* RETAIN of the present record was said */

/* The facts ever said: of a giver's token 1 + its receiver, of a receiver's TAKE a bit. */
byte offer_said[NODES * TOKENS], released_said[NODES * TOKENS], retained_said[NODES * TOKENS];
bool take_said[NODES * NODES * TOKENS];
bool stable_said[NODES];    /* a STATE that says TAKEN and stable */
#define TAKE(receiver, giver, token) take_said[(receiver) * NODES * TOKENS + AT(giver, token)]

bool calm;
byte left;                  /* moves that calm may still take */

#define COPY(to, from) \
  to.kind = from.kind; to.peer = from.peer; to.token = from.token; to.number = from.number; \
  for (i : 0 .. NODES - 1) { to.last[i] = from.last[i] } \
  for (i : 0 .. TOKENS - 1) { to.outcome[i] = from.outcome[i]; to.receiver[i] = from.receiver[i] }

#define DURABLE(n) (!storing[n])
#define SAVE(n) storing[n] = true
#ifdef NO_R6
#define DECISION_STORED(n) (ram[n].kind == DECIDED)
#else
#define DECISION_STORED(n) (DURABLE(n) && ram[n].kind == DECIDED)
#endif

#define ANSWERS(n) (grip[n] == FULL && (st[n] == TAKEN || st[n] == HOLD || st[n] == OFFERED || st[n] == RESQUEEZE))
#define GONE(n) (released_said[AT(nvm[n].peer, nvm[n].token)] == n + 1 || \
  (nvm[nvm[n].peer].outcome[nvm[n].token - 1] == 1 && nvm[nvm[n].peer].receiver[nvm[n].token - 1] == n))

inline check() {
  held = 0; custodians = 0;
  for (i : 0 .. NODES - 1) {
    if :: ANSWERS(i) -> held++ :: else fi;
    if
    :: nvm[i].kind == SOLE || nvm[i].kind == OFFER_OUT || nvm[i].kind == RETAINED || nvm[i].kind == DECIDED -> custodians++
    :: nvm[i].kind == LATCHED -> if :: GONE(i) -> custodians++ :: else fi
    :: else
    fi
  }
  assert(held > 0);         /* I2 */
  assert(custodians == 1);  /* I2b */
  held = 0; custodians = 0; i = 0
}

/* Moves of one node; each is one step, and each may come at any time. */
inline store(n) { COPY(nvm[n], ram[n]); storing[n] = false }

inline restart(n) {
  COPY(ram[n], nvm[n]);
  storing[n] = false; proven[n] = false; freed[n] = false; retain_said[n] = false;
  if
  :: ram[n].kind == SOLE || ram[n].kind == RETAINED -> st[n] = HOLD
  :: ram[n].kind == OFFER_OUT -> st[n] = RESQUEEZE
  :: ram[n].kind == DECIDED -> st[n] = OPENING
#ifndef NO_LATCH
  :: ram[n].kind == LATCHED -> st[n] = TAKEN
#else
  :: ram[n].kind == LATCHED -> st[n] = STRANDED; freed[n] = true
#endif
  :: else -> if :: grip[n] == OPEN -> st[n] = IDLE :: else -> st[n] = STRANDED fi
  fi
}

inline offer(n, p) {
#ifndef NO_R7
  ram[n].number = ram[n].number + 1;
#else
  ram[n].number = 1;
#endif
  ram[n].kind = OFFER_OUT; ram[n].peer = p; ram[n].token = ram[n].number;
  ram[n].receiver[ram[n].token - 1] = p; ram[n].outcome[ram[n].token - 1] = 0;
  st[n] = OFFERED; SAVE(n)
}

inline accept(n, g, t) {
  ram[n].kind = EMPTY; ram[n].peer = g; ram[n].token = t; ram[n].last[g] = t;
  st[n] = SEATED; freed[n] = false; SAVE(n)
}

inline conclude(n, how) {
  ram[n].outcome[ram[n].token - 1] = how;
  if :: how == 1 -> ram[n].kind = RELEASED :: else -> ram[n].kind = RETAINED fi;
  retain_said[n] = false; SAVE(n)
}

#ifdef NO_R4
#define HEARS_TAKE(n) (stable_said[ram[n].peer] && (TAKE(ram[n].peer, n, ram[n].token) || \
  (TOKENS > 1 && TAKE(ram[n].peer, n, 1))))
#else
#define HEARS_TAKE(n) (stable_said[ram[n].peer] && TAKE(ram[n].peer, n, ram[n].token))
#endif
#define HEARS_RELEASED(n) (released_said[AT(ram[n].peer, ram[n].token)] == n + 1)
#define HEARS_RETAINED(n) (retained_said[AT(ram[n].peer, ram[n].token)] == n + 1)
#define HEARS_OFFER(n) (offer_said[AT(ram[n].peer, ram[n].token)] == n + 1)
#ifdef NO_R8
#define NEWER(n, g, t) true
#else
#define NEWER(n, g, t) ((t) > ram[n].last[g])
#endif
#ifdef NO_R5
#define GOOD(n) true
#else
#define GOOD(n) (grip[n] == FULL)
#endif
#ifdef NO_R2
#define STABLE(n) (grip[n] != OPEN)
#else
#define STABLE(n) (grip[n] == FULL)
#endif
#ifdef NO_R1
#define MAY_TAKE(n) (ram[n].kind == LATCHED)
#else
#define MAY_TAKE(n) (DURABLE(n) && ram[n].kind == LATCHED)
#endif
#ifdef NO_R7
#define MAY_OFFER(n) true
#else
#define MAY_OFFER(n) (ram[n].number < TOKENS)
#endif

#define GIVING(p) \
  :: atomic { !calm && st[me] == HOLD && DURABLE(me) && p < NODES && p != me && MAY_OFFER(me) && \
       (ram[me].kind != RETAINED || retain_said[me]) -> offer(me, p); check() }
#define TAKING(g, t) \
  :: atomic { !calm && st[me] == IDLE && grip[me] == OPEN && DURABLE(me) && g < NODES && t <= TOKENS && g != me && \
       offer_said[AT(g, t)] == me + 1 && NEWER(me, g, t) -> accept(me, g, t); check() }
#ifndef NO_R10
#define REPEATING(t) \
  :: atomic { !calm && DURABLE(me) && t <= TOKENS && ram[me].outcome[t - 1] == 1 && !released_said[AT(me, t)] -> \
       released_said[AT(me, t)] = ram[me].receiver[t - 1] + 1 } \
  :: atomic { !calm && DURABLE(me) && t <= TOKENS && ram[me].outcome[t - 1] == 2 && !retained_said[AT(me, t)] && \
       (ram[me].token != t || ram[me].kind != RETAINED) -> retained_said[AT(me, t)] = ram[me].receiver[t - 1] + 1 }
#else
#define REPEATING(t)
#endif

proctype Node(byte me) {
  byte i, held, custodians;
end:
  do
  :: atomic { !calm && storing[me] -> store(me); check() }
  :: atomic { !calm -> restart(me); check() }
  GIVING(0) GIVING(1) GIVING(2)
  TAKING(0, 1) TAKING(1, 1) TAKING(2, 1) TAKING(0, 2) TAKING(1, 2) TAKING(2, 2)
  REPEATING(1) REPEATING(2)
  /* the giver */
  :: atomic { !calm && (st[me] == OFFERED || st[me] == RELAX) && DURABLE(me) && ram[me].kind == OFFER_OUT && \
       !offer_said[AT(me, ram[me].token)] -> offer_said[AT(me, ram[me].token)] = ram[me].peer + 1 }
  :: atomic { !calm && st[me] == OFFERED -> st[me] = HOLD; conclude(me, 2); check() }
  :: atomic { !calm && st[me] == OFFERED && DURABLE(me) && HEARS_TAKE(me) -> st[me] = RELAX; check() }
  :: atomic { !calm && st[me] == RELAX && grip[me] == FULL -> grip[me] = LIGHT; check() }
  :: atomic { !calm && st[me] == RELAX -> st[me] = RESQUEEZE; check() }
  :: atomic { !calm && st[me] == RELAX && HEARS_TAKE(me) -> ram[me].kind = DECIDED; st[me] = OPENING; SAVE(me); check() }
  :: atomic { !calm && st[me] == RESQUEEZE && grip[me] == OPEN -> grip[me] = LIGHT; check() }
  :: atomic { !calm && st[me] == RESQUEEZE && grip[me] == LIGHT -> grip[me] = FULL; check() }
  :: atomic { !calm && st[me] == RESQUEEZE && GOOD(me) -> st[me] = HOLD; conclude(me, 2); check() }
  :: atomic { !calm && st[me] == OPENING && DECISION_STORED(me) && grip[me] == FULL -> assert(nvm[me].kind == DECIDED); grip[me] = LIGHT; check() }
  :: atomic { !calm && st[me] == OPENING && DECISION_STORED(me) && grip[me] == LIGHT -> assert(nvm[me].kind == DECIDED); grip[me] = OPEN; check() }
  :: atomic { !calm && st[me] == OPENING && DECISION_STORED(me) && grip[me] == OPEN -> st[me] = IDLE; conclude(me, 1); check() }
  :: atomic { !calm && ram[me].kind == RELEASED && DURABLE(me) && !released_said[AT(me, ram[me].token)] -> \
       released_said[AT(me, ram[me].token)] = ram[me].peer + 1; check() }
  :: atomic { !calm && ram[me].kind == RETAINED && DURABLE(me) && GOOD(me) && !retain_said[me] -> \
       retained_said[AT(me, ram[me].token)] = ram[me].peer + 1; retain_said[me] = true; check() }
#ifdef NO_R9
  :: atomic { !calm && st[me] == HOLD && grip[me] != OPEN -> grip[me] = OPEN; check() }
#endif
#ifdef RETAIN_AFTER_DECISION
  :: atomic { !calm && st[me] == OPENING -> retained_said[AT(me, ram[me].token)] = ram[me].peer + 1; check() }
#endif
  /* the receiver */
  :: atomic { !calm && st[me] == SEATED && DURABLE(me) && grip[me] == OPEN -> grip[me] = LIGHT; check() }
  :: atomic { !calm && st[me] == SEATED && DURABLE(me) && grip[me] != OPEN && HEARS_OFFER(me) && !freed[me] -> \
       st[me] = SQUEEZING; check() }
  :: atomic { !calm && st[me] == SQUEEZING && grip[me] == LIGHT -> grip[me] = FULL; check() }
  :: atomic { !calm && st[me] == SQUEEZING -> st[me] = SEATED; check() }
  :: atomic { !calm && st[me] == SQUEEZING && STABLE(me) -> ram[me].kind = LATCHED; st[me] = TAKEN; proven[me] = true; SAVE(me); check() }
  :: atomic { !calm && st[me] == TAKEN && !proven[me] && STABLE(me) -> proven[me] = true }
  :: atomic { !calm && st[me] == TAKEN && grip[me] != FULL -> grip[me] = FULL; check() }
  :: atomic { !calm && st[me] == TAKEN && proven[me] && MAY_TAKE(me) -> TAKE(me, ram[me].peer, ram[me].token) = true; \
       if :: grip[me] == FULL -> stable_said[me] = true :: else fi; check() }
  :: atomic { !calm && st[me] == TAKEN && HEARS_RELEASED(me) -> ram[me].kind = SOLE; st[me] = HOLD; SAVE(me); check() }
  :: atomic { !calm && st[me] == TAKEN && HEARS_RETAINED(me) -> ram[me].kind = EMPTY; st[me] = SEATED; freed[me] = true; SAVE(me); check() }
#ifdef NO_R3
  :: atomic { !calm && st[me] == TAKEN -> ram[me].kind = EMPTY; st[me] = SEATED; freed[me] = true; SAVE(me); check() }
#endif
#ifdef SOLE_WITHOUT_RELEASED
  :: atomic { !calm && st[me] == TAKEN -> ram[me].kind = SOLE; st[me] = HOLD; SAVE(me); check() }
#endif
  :: atomic { !calm && (st[me] == SEATED || st[me] == STRANDED || st[me] == SQUEEZING) && \
       (freed[me] || HEARS_OFFER(me) || HEARS_RETAINED(me)) && ram[me].kind != SOLE -> st[me] = IDLE; freed[me] = true; check() }
  :: atomic { !calm && st[me] == IDLE && freed[me] && grip[me] == FULL -> grip[me] = LIGHT; check() }
  :: atomic { !calm && st[me] == IDLE && freed[me] && grip[me] == LIGHT -> grip[me] = OPEN; check() }
  od
}

/* What a giver repeats now of the handoff that receiver `n` is in; everything older is lost. */
#ifdef NO_R10
#define REPEATS(n, how) (DURABLE(ram[n].peer) && ram[ram[n].peer].token == ram[n].token && ram[ram[n].peer].peer == n && \
  (ram[ram[n].peer].kind == RELEASED && how == 1 || ram[ram[n].peer].kind == RETAINED && how == 2))
#else
#define REPEATS(n, how) (DURABLE(ram[n].peer) && ram[ram[n].peer].outcome[ram[n].token - 1] == how && \
  ram[ram[n].peer].receiver[ram[n].token - 1] == n)
#endif
#define AT_REST(n) (DURABLE(n) && (st[n] == HOLD && grip[n] == FULL || st[n] == IDLE && grip[n] == OPEN))

active proctype Calm() {
  byte n, i, held, custodians;
  bool moved;
  atomic {
    for (n : 0 .. NODES - 1) {
      st[n] = IDLE; grip[n] = OPEN; ram[n].kind = EMPTY; nvm[n].kind = EMPTY
    }
    st[0] = HOLD; grip[0] = FULL; ram[0].kind = SOLE; nvm[0].kind = SOLE; proven[0] = true;
    for (n : 0 .. NODES - 1) { run Node(n) }
    n = 0
  }
end:
  atomic { true -> calm = true; left = 40 }
  do
  :: d_step {
    moved = false; n = 0;
    do
    :: n < NODES && !moved ->
      if
      :: storing[n] -> store(n); moved = true
      :: !storing[n] && st[n] == OFFERED -> st[n] = HOLD; conclude(n, 2); moved = true
      :: !storing[n] && st[n] == RELAX -> st[n] = RESQUEEZE; moved = true
      :: !storing[n] && st[n] == RESQUEEZE && grip[n] != FULL -> grip[n] = FULL; moved = true
      :: !storing[n] && st[n] == RESQUEEZE && grip[n] == FULL -> st[n] = HOLD; conclude(n, 2); moved = true
      :: !storing[n] && st[n] == OPENING && ram[n].kind == DECIDED -> grip[n] = OPEN; st[n] = IDLE; conclude(n, 1); moved = true
      :: !storing[n] && st[n] == HOLD && grip[n] != FULL -> grip[n] = FULL; moved = true
      :: !storing[n] && st[n] == TAKEN && grip[n] != FULL -> grip[n] = FULL; moved = true
      :: !storing[n] && st[n] == TAKEN && grip[n] == FULL && REPEATS(n, 1) -> ram[n].kind = SOLE; st[n] = HOLD; SAVE(n); moved = true
      :: !storing[n] && st[n] == TAKEN && grip[n] == FULL && REPEATS(n, 2) -> ram[n].kind = EMPTY; st[n] = SEATED; freed[n] = true; SAVE(n); moved = true
      :: !storing[n] && (st[n] == SEATED || st[n] == SQUEEZING || st[n] == STRANDED) && (freed[n] || REPEATS(n, 2)) -> st[n] = IDLE; freed[n] = true; moved = true
      :: !storing[n] && st[n] == IDLE && grip[n] != OPEN && freed[n] -> grip[n] = OPEN; moved = true
      :: else -> n++
      fi
    :: else -> break
    od;
    n = 0;
    if
    :: moved -> assert(left > 0); left--
    :: else ->
      for (n : 0 .. NODES - 1) { assert(AT_REST(n)) }  /* I2c */
      n = 0
    fi;
    if :: moved -> check() :: else fi
    }
    if :: !moved -> break :: else fi
  od
}
