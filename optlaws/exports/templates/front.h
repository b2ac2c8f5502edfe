/* name: laws of a proven front, chosen at run time.
 *
 * HEADING
 */

#ifndef GUARD
#define GUARD

#include <math.h>

/* What is proven of a move; there is no motion from TOO_SHORT on. */
enum {
    NAME_PROVEN = 0,    /* limits kept, within the gap of the best */
    NAME_AT_END = 1,    /* limits kept, by the law at an end of the front */
    NAME_JERK = 2,      /* limits kept, the jerk decides the time */
    NAME_TOO_SHORT = 3, /* no law of the front is as fast */
    NAME_REFUSED = 4    /* a stroke, time or limit that is none */
};

/* A move: the mean of a law of the table and the next one, whose weight is the share. */
typedef struct {
    int status;
    int law;
    double share;
    double stroke;
    double duration;
    double velocity;     /* magnitudes that the motion does not exceed */
    double acceleration;
    double jerk;
} name_move;

TABLES

static inline int name_in_range(double value)
{
    return value >= LEAST && value <= MOST;
}

static inline int name_set(double stroke, double duration, int status, int law, double share, name_move *move)
{
    const double of_b = name_b[law] + share * (name_b[law + 1] - name_b[law]);
    const double of_c = name_c[law] + share * (name_c[law + 1] - name_c[law]);
    const double of_j = name_j[law] + share * (name_j[law + 1] - name_j[law]);
    const double moves = (status < NAME_TOO_SHORT && duration > 0.0) ? fabs(stroke) : 0.0;
    const double time = moves > 0.0 ? duration : 1.0;
    move->status = status;
    move->law = law;
    move->share = share;
    move->stroke = stroke;
    move->duration = duration;
    move->velocity = WIDENED * of_b * (moves / time);
    move->acceleration = WIDENED * of_c * (moves / time / time);
    move->jerk = WIDENED * of_j * (moves / time / time / time);
    return status;
}

static inline double name_share(int law, double z)
{
    const double share = (z - name_b[law]) / (name_b[law + 1] - name_b[law]);
    return share < 0.0 ? 0.0 : (share > 1.0 ? 1.0 : share);
}

/* The least time within limits of velocity, acceleration and jerk; the status, which the move holds too. */
static inline int name_least_time(double stroke, double velocity, double acceleration, double jerk,
                                    name_move *move)
{
    double rate;
    double of_c;
    double of_j;
    double z;
    double by_jerk;
    int low = 0;
    int high = COUNT;
    if (!name_in_range(velocity) || !name_in_range(acceleration) || !name_in_range(jerk)
        || !(stroke == 0.0 || name_in_range(fabs(stroke)))) {
        return name_set(0.0, 0.0, NAME_REFUSED, 0, 0.0, move);
    }
    if (stroke == 0.0) {
        return name_set(0.0, 0.0, NAME_PROVEN, 0, 0.0, move);
    }
    rate = velocity / fabs(stroke);
    of_c = velocity / acceleration * rate;
    of_j = velocity / jerk * rate * rate;
    while (low < high) {
        const int middle = (low + high) / 2;
        const double b = name_b[middle];
        if (b * b >= of_c * name_c[middle] && b * b * b >= of_j * name_j[middle]) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    if (low == 0) {
        return name_set(stroke, name_b[0] / rate * WIDENED, AT_FIRST, 0, 0.0, move);
    }
    if (low == COUNT) {
        z = sqrt(of_c * name_c[LAST]);
        by_jerk = cbrt(of_j * name_j[LAST]);
        return name_set(stroke, (by_jerk > z ? by_jerk : z) / rate * WIDENED,
                          by_jerk > z ? NAME_JERK : AT_LAST, BEFORE, 1.0, move);
    }
    low -= 1;
    {
        const double width = name_b[low + 1] - name_b[low];
        const double m = of_c * ((name_c[low] - name_c[low + 1]) / width);
        const double n = of_c * name_c[low] + m * name_b[low];
        const double third = of_j * ((name_j[low] - name_j[low + 1]) / width) / 3.0;
        const double right = of_j * name_j[low] + 3.0 * third * name_b[low];
        const double u = cbrt(0.5 * right + sqrt(0.25 * right * right + third * third * third));
        const double v = third / u;
        z = 2.0 * n / (m + sqrt(m * m + 4.0 * n));
        by_jerk = right / (u * u + third + v * v);
    }
    {
        const int status = by_jerk > z ? NAME_JERK : NAME_PROVEN;
        z = by_jerk > z ? by_jerk : z;
        z = z < name_b[low] ? name_b[low] : (z > name_b[low + 1] ? name_b[low + 1] : z);
        return name_set(stroke, z / rate * WIDENED, status, low, name_share(low, z), move);
    }
}

/* The least acceleration in a given time within a limit of the velocity; the status, which the move holds too. */
static inline int name_in_time(double stroke, double duration, double velocity, name_move *move)
{
    double z;
    int low = 0;
    int high = LAST;
    if (!name_in_range(duration) || !name_in_range(velocity)
        || !(stroke == 0.0 || name_in_range(fabs(stroke)))) {
        return name_set(0.0, 0.0, NAME_REFUSED, 0, 0.0, move);
    }
    if (stroke == 0.0) {
        return name_set(0.0, duration, NAME_PROVEN, 0, 0.0, move);
    }
    z = velocity * duration / fabs(stroke) / WIDENED;
    if (z < name_b[0]) {
        return name_set(0.0, 0.0, NAME_TOO_SHORT, 0, 0.0, move);
    }
    if (z >= name_b[LAST]) {
        return name_set(stroke, duration, AT_LAST, BEFORE, 1.0, move);
    }
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (z >= name_b[middle]) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return name_set(stroke, duration, NAME_PROVEN, low, name_share(low, z), move);
}

/* Position, velocity, acceleration and jerk at a time since the move began; at rest before it and after it. */
static inline void name_motion(const name_move *move, double time, double motion[4])
{
    double p0 = 0.0, p1 = 0.0, p2 = 0.0, p3 = 0.0;
    double q0 = 0.0, q1 = 0.0, q2 = 0.0, q3 = 0.0;
    double s0, s1, s2, s3;
    double k, x, y, rate;
    const double *row;
    const double *next;
    int n;
    motion[0] = 0.0;
    motion[1] = 0.0;
    motion[2] = 0.0;
    motion[3] = 0.0;
    if (move->status > NAME_JERK || move->stroke == 0.0 || !(time >= 0.0)) {
        return;
    }
    if (time > move->duration) {
        motion[0] = move->stroke;
        return;
    }
    k = time / move->duration;
#if PIECES
    {
        int piece = 0;
        int high = LAST_PIECE;
        while (piece < high) {
            const int middle = (piece + high + 1) / 2;
            if (k >= name_breaks[middle]) {
                piece = middle;
            } else {
                high = middle - 1;
            }
        }
        row = name_series[move->law][piece];
        next = name_series[move->law + 1][piece];
        rate = name_scales[piece] / move->duration;
        x = name_scales[piece] * (k - name_breaks[piece]) - 1.0;
    }
#else
    row = name_series[move->law];
    next = name_series[move->law + 1];
    rate = 2.0 / move->duration;
    x = 2.0 * k - 1.0;
#endif
    x = x < -1.0 ? -1.0 : (x > 1.0 ? 1.0 : x);
    y = 2.0 * x;
    for (n = HIGHEST; n > 0; --n) {
        const double c = row[n] + move->share * (next[n] - row[n]);
        s0 = y * p0 - q0 + c;
        s1 = y * p1 - q1 + 2.0 * p0;
        s2 = y * p2 - q2 + 4.0 * p1;
        s3 = y * p3 - q3 + 6.0 * p2;
#if ODD
        p0 = y * s0 - p0;
        p1 = y * s1 - p1 + 2.0 * s0;
        p2 = y * s2 - p2 + 4.0 * s1;
        p3 = y * s3 - p3 + 6.0 * s2;
        q0 = s0;
        q1 = s1;
        q2 = s2;
        q3 = s3;
#else
        q0 = p0;
        q1 = p1;
        q2 = p2;
        q3 = p3;
        p0 = s0;
        p1 = s1;
        p2 = s2;
        p3 = s3;
#endif
    }
#if ODD
    s0 = y * p0 - q0 + (row[0] + move->share * (next[0] - row[0]));
    s1 = y * p1 - q1 + 2.0 * p0;
    s2 = y * p2 - q2 + 4.0 * p1;
    s3 = y * p3 - q3 + 6.0 * p2;
    s3 = x * s3 - p3 + 3.0 * s2;
    s2 = x * s2 - p2 + 2.0 * s1;
    s1 = x * s1 - p1 + s0;
    s0 = x * s0 - p0 + 0.5;
#else
    s0 = x * p0 - q0 + (row[0] + move->share * (next[0] - row[0]));
    s1 = x * p1 - q1 + p0;
    s2 = x * p2 - q2 + 2.0 * p1;
    s3 = x * p3 - q3 + 3.0 * p2;
#endif
    motion[0] = move->stroke * s0;
    motion[1] = move->stroke * rate * s1;
    motion[2] = move->stroke * rate * rate * s2;
    motion[3] = move->stroke * rate * rate * rate * s3;
}

#endif /* GUARD */
