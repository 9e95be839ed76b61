"""Reference values for `mechanisms/stewart_platform.mech`, by Newton and Euler.

Nothing of bricard takes part: the platform is a free rigid body with a quaternion for
its rotation and its angular velocity in the body's frame,

    m a = sum f_i u_i - m g e_z,      I w' + w x I w = R^T sum (R s_i) x (f_i u_i),

where leg i pushes with f_i along its unit vector u_i at the joint s_i of the platform.
Integrated by extrapolation of the modified midpoint rule (Gragg, Bulirsch, Stoer) of
order 16; two step sizes agree to the error in the last column.

    python3 tests/reference/stewart_platform.py > tests/reference/stewart_platform.csv
"""

from math import atan2, asin, cos, pi, sin, sqrt

G, A, B, M, J1, J3 = 9.81, 1.0, 0.6, 50.0, 5.0, 9.0
K, D, L0, STROKE, W = 20000.0, 300.0, 1.2, 0.05, 6.0
BELOW = [-15, 15, 105, 135, 225, 255]
ABOVE = [-45, 45, 75, 165, 195, 285]
FEET = [(A * cos(x * pi / 180), A * sin(x * pi / 180), 0.0) for x in BELOW]
JOINTS = [(B * cos(x * pi / 180), B * sin(x * pi / 180), 0.0) for x in ABOVE]
TIMES = [0.25, 0.5, 1.0, 2.0]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def rotation(e):
    w, x, y, z = e
    n = w * w + x * x + y * y + z * z
    return [
        [1 - 2 * (y * y + z * z) / n, 2 * (x * y - w * z) / n, 2 * (x * z + w * y) / n],
        [2 * (x * y + w * z) / n, 1 - 2 * (x * x + z * z) / n, 2 * (y * z - w * x) / n],
        [2 * (x * z - w * y) / n, 2 * (y * z + w * x) / n, 1 - 2 * (x * x + y * y) / n],
    ]


def turned(r, v):
    return tuple(sum(r[i][j] * v[j] for j in range(3)) for i in range(3))


def turned_back(r, v):
    return tuple(sum(r[j][i] * v[j] for j in range(3)) for i in range(3))


def rate(t, y):
    """The rate of position, quaternion, velocity and angular velocity."""
    p, e, v, w = y[0:3], y[3:7], y[7:10], y[10:13]
    r = rotation(e)
    told, told_rate = L0 + STROKE * sin(W * t), STROKE * W * cos(W * t)
    force, moment = [0.0, 0.0, -M * G], [0.0, 0.0, 0.0]
    for foot, joint in zip(FEET, JOINTS):
        arm, swing = turned(r, joint), turned(r, cross(w, joint))
        leg = [p[i] + arm[i] - foot[i] for i in range(3)]
        length = sqrt(sum(x * x for x in leg))
        u = [x / length for x in leg]
        length_rate = sum(u[i] * (v[i] + swing[i]) for i in range(3))
        f = M * G / 6 - K * (length - told) - D * (length_rate - told_rate)
        push = [f * x for x in u]
        turn = cross(joint, turned_back(r, push))
        for i in range(3):
            force[i] += push[i]
            moment[i] += turn[i]
    spin = (J1 * w[0], J1 * w[1], J3 * w[2])
    gyro = cross(w, spin)
    dw = [(moment[i] - gyro[i]) / (J1, J1, J3)[i] for i in range(3)]
    a, b, c, d = e
    de = [
        (-b * w[0] - c * w[1] - d * w[2]) / 2,
        (a * w[0] + c * w[2] - d * w[1]) / 2,
        (a * w[1] + d * w[0] - b * w[2]) / 2,
        (a * w[2] + b * w[1] - c * w[0]) / 2,
    ]
    return list(v) + de + [x / M for x in force] + dw


def midpoint(t, y, span, steps):
    h = span / steps
    before, now = y, [a + h * b for a, b in zip(y, rate(t, y))]
    for i in range(1, steps):
        before, now = now, [a + 2 * h * b for a, b in zip(before, rate(t + i * h, now))]
    last = rate(t + span, now)
    return [(a + b + h * c) / 2 for a, b, c in zip(before, now, last)]


def step(t, y, span):
    row = []
    for k in range(1, 9):
        new = [midpoint(t, y, span, 2 * k)]
        for j in range(1, k):
            factor = (k / (k - j)) ** 2 - 1
            new.append([a + (a - b) / factor for a, b in zip(new[j - 1], row[j - 1])])
        row = new
    return row[-1]


def start():
    # R = rotx(1 deg) roty(2 deg)
    a, b = pi / 360, 2 * pi / 360
    e = [cos(a) * cos(b), sin(a) * cos(b), cos(a) * sin(b), sin(a) * sin(b)]
    return [0.02, 0.0, 1.0] + e + [0.0] * 6


def shown(y):
    """Position, angles about x, y, z in this order, velocity, in space."""
    r = rotation(y[3:7])
    angles = [atan2(-r[1][2], r[2][2]), asin(r[0][2]), atan2(-r[0][1], r[0][0])]
    return y[0:3] + angles + y[7:10]


def ends(per_second):
    y, n, found = start(), 0, []
    for until in TIMES:
        while n < round(until * per_second):
            y = step(n / per_second, y, 1 / per_second)
            n += 1
        found.append(shown(y))
    return found


def main():
    print("# The Stewart platform of the library by Newton's and Euler's equations:")
    print("# see stewart_platform.py. Position (m), Cardan angles (rad), velocity (m/s).")
    print("t_s,x,y,z,angle0,angle1,angle2,vx,vy,vz,abs_error")
    for t, fine, coarse in zip(TIMES, ends(160), ends(100)):
        error = max(abs(a - b) for a, b in zip(fine, coarse))
        print(",".join([repr(t)] + [repr(x) for x in fine] + ["%.0e" % error]))


main()
