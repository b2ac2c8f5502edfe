TABLES

/* The piece that holds x: the first before the motion, the last after it. */
static inline int name_piece(double x)
{
    int low = 0;
    int high = LAST_PIECE;
    while (low < high) {
        int middle = (low + high + 1) / 2;
        if (x >= name_breaks[middle]) {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    return low;
}

/* Position, velocity, acceleration and jerk at x; outside the motion those of its nearer end. */
static inline void name_motion(double x, double motion[4])
{
    const double first = name_breaks[0];
    const double last = name_breaks[LAST];
    const double place = x < first ? first : (x < last ? x : last);
    const int piece = name_piece(place);
    const double *powers = name_coefficients[piece];
    const double s = place - name_breaks[piece];
    double position = powers[DEGREE];
    double velocity = 0.0;
    double acceleration = 0.0;
    double jerk = 0.0;
    int power;
    for (power = DEGREE - 1; power >= 0; --power) {
        jerk = jerk * s + acceleration;
        acceleration = acceleration * s + velocity;
        velocity = velocity * s + position;
        position = position * s + powers[power];
    }
    motion[0] = position;
    motion[1] = velocity;
    motion[2] = 2.0 * acceleration;
    motion[3] = 6.0 * jerk;
}

static inline double name_position(double x)
{
    double motion[4];
    name_motion(x, motion);
    return motion[0];
}

static inline double name_velocity(double x)
{
    double motion[4];
    name_motion(x, motion);
    return motion[1];
}

static inline double name_acceleration(double x)
{
    double motion[4];
    name_motion(x, motion);
    return motion[2];
}

static inline double name_jerk(double x)
{
    double motion[4];
    name_motion(x, motion);
    return motion[3];
}
