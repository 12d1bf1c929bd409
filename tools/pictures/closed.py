"""Closed forms and equations that the examples are compared with."""
import numpy as np


def root(x):
    """Square root, zero for what is negative."""
    return np.sqrt(np.maximum(x, 0.0))


def midpoints(n):
    """Of n equal parts of [0, 1]."""
    return (np.arange(n) + 0.5) / n


class Line:
    """Cylinder on a half plane (Hertz): R mm, P N/mm, E N/mm^2, nu."""

    def __init__(self, R=10.0, P=1000.0, E=210e3, nu=0.3):
        self.R, self.P, self.nu = R, P, nu
        self.E = E / (1 - nu ** 2)
        self.a = np.sqrt(4 * P * R / (np.pi * self.E))
        self.p0 = 2 * P / (np.pi * self.a)

    def pressure(self, x):
        return self.p0 * root(1 - (x / self.a) ** 2)


class Sphere:
    """Sphere on a half space (Hertz)."""

    def __init__(self, R=10.0, P=1000.0, E=210e3, nu=0.3):
        self.a = (3 * P * R * (1 - nu ** 2) / (4 * E)) ** (1 / 3)
        self.p0 = 1.5 * P / (np.pi * self.a ** 2)

    def pressure(self, r):
        return self.p0 * root(1 - (r / self.a) ** 2)


# ---- friction under Hertz's pressure -----------------------------------

def cattaneo(line, x, mu, share):
    """Shear traction under the tangential force share*mu*P, and c/a."""
    c = line.a * np.sqrt(1 - share)
    return mu * (line.pressure(x)
                 - line.p0 * c / line.a * root(1 - (x / c) ** 2)), c / line.a


def slip(line, x, mu, share):
    """Displacement along the surface under that force, zero in the stick: its
    gradient is -2 mu p0/(E a) (sqrt(x^2 - c^2) - sqrt(x^2 - a^2)), the roots
    zero within c and a, the difference of two of Hertz's fields."""
    def area(c):
        z = np.maximum(np.abs(x) / c, 1.0)
        return c * c * (z * np.sqrt(z * z - 1) - np.arccosh(z))

    c = line.a * np.sqrt(1 - share)
    return -mu * line.p0 / (line.E * line.a) * (area(c) - area(line.a))


def loop(line, x, mu, share, weights):
    """Force and mean slip over one cycle between -share and share of mu P, by
    the rule of Masing: after a reversal a branch is twice the first one."""
    def mean(s):
        return np.sum(weights * slip(line, x, mu, s)) / np.sum(weights)

    shares = np.linspace(0, share, 60)
    first = np.array([mean(s) for s in shares])
    back = first[-1] - 2 * np.array([mean(s / 2) for s in 2 * shares])
    force, back_force = shares, share - 2 * shares
    forth, forth_force = -back, -back_force
    return (mu * line.P * np.concatenate([force, back_force, forth_force]),
            np.concatenate([first, back, forth]))


def flat_punch(beta, mu, n=400):
    """Flat rigid punch of half-width 1 and load 1 on a half plane with
    friction (Spence 1973): places, pressure and shear in n parts of [0, 1], and
    the edge c of the stick. Ux = 0 for x < c, shear = mu pressure beyond,
      Ux = -1/pi int q ln|x - s| - beta int_0^x p,
      Uz = -1/pi int p ln|x - s| + beta int_0^x q = const
    (Johnson, Contact Mechanics, 2.24, over 2 (1 - nu^2)/E)."""
    edge = np.sin(np.linspace(0, np.pi / 2, n + 1))
    x, h = (edge[1:] + edge[:-1]) / 2, np.diff(edge)

    def potential(s):
        d = s[None, :] - x[:, None]
        return d * np.log(np.abs(d)) - d

    right = potential(edge[1:]) - potential(edge[:-1])
    left = potential(-edge[:-1]) - potential(-edge[1:])
    until = np.tril(np.tile(h, (n, 1)), -1) + np.diag(h / 2)

    def solve(stick):
        # unknowns: p[n], q[n], depth; the last row is the load
        A, b = np.zeros((2 * n + 1, 2 * n + 1)), np.zeros(2 * n + 1)
        A[:n, :n] = -(right + left) / np.pi
        A[:n, n:2 * n] = beta * until
        A[:n, -1] = -1
        A[n:2 * n, :n] = -beta * until
        A[n:2 * n, n:2 * n] = -(right - left) / np.pi
        A[n + stick:2 * n] = 0
        rows = np.arange(n + stick, 2 * n)
        A[rows, rows], A[rows, rows - n] = 1, -mu
        A[-1, :n], b[-1] = 2 * h, 1
        found = np.linalg.solve(A, b)
        return found[:n], found[n:2 * n]

    low, high = 1, n - 1  # shear is above the limit at the edge of a long stick
    while high - low > 1:
        middle = (low + high) // 2
        p, q = solve(middle)
        if q[middle - 1] < mu * p[middle - 1]:
            low = middle
        else:
            high = middle
    return x, *solve(low), edge[low]


def spence(line, mu, shrink, x):
    """Pressure and shear under a parabola whose load grows (Spence 1975): the
    flat punches of all half-widths s up to a, each with the load dP = 2 P s/a^2
    ds. shrink: a over that of Hertz. Also c/a."""
    beta = (1 - 2 * line.nu) / (2 - 2 * line.nu)
    t, p, q, c = flat_punch(beta, mu)
    a = shrink * line.a

    def whole(f, y):
        s = y + (a - y) * midpoints(4000) ** 2
        ds = np.diff(y + (a - y) * np.linspace(0, 1, 4001) ** 2)
        return 2 * line.P / a ** 2 * np.sum(np.interp(y / s, t, f) * ds)

    y = np.abs(x)
    inside = y < a
    pressure, shear = np.zeros(len(x)), np.zeros(len(x))
    pressure[inside] = [whole(p, v) for v in y[inside]]
    shear[inside] = [whole(q, v) for v in y[inside]]
    return pressure, shear, c


def sliding(line, x, mu):
    """Pressure under full slip with coupling (Johnson 8.3), l and e."""
    e = np.arctan(mu * (1 - 2 * line.nu) / (2 - 2 * line.nu)) / np.pi
    half = np.sqrt(4 * line.P * line.R / (np.pi * line.E * (1 - 4 * e * e)))
    s = np.clip(x + 2 * e * half, -half, half)
    return (line.E * np.cos(np.pi * e) / (2 * line.R) * (half - s) ** (0.5 + e)
            * (half + s) ** (0.5 - e))


# ---- torsion (Lubkin) --------------------------------------------------

def elliptic(k):
    """Complete integrals K and E of the modulus k < 1, by the
    arithmetic-geometric mean."""
    a, b, c = np.ones_like(k), np.sqrt(1 - k * k), np.array(k, float)
    power, total = 0.5, 0.5 * c * c
    for _ in range(12):
        a, b, c = (a + b) / 2, np.sqrt(a * b), (a - b) / 2
        power *= 2
        total = total + power * c * c
    K = np.pi / (2 * a)
    return K, K * (1 - total)


def k_less_e(s):
    """K - E of the modulus sqrt(1 - s^2)."""
    K, E = elliptic(np.sqrt(1 - np.minimum(s, 1 - 1e-12) ** 2))
    return K - E


class Torsion(Sphere):
    """A pressed sphere turned about the normal, stick up to c in radii."""

    def __init__(self, mu=0.4, nu=0.3, P=1000.0, E=210e3):
        super().__init__(P=P, E=E, nu=nu)
        self.mu, self.P, self.G = mu, P, E / (2 * (1 + nu))

    def angle(self, c):
        return (3 * self.mu * self.P / (4 * np.pi * self.G * self.a ** 2)
                * k_less_e(c))

    def torque(self, c):
        s = c + (1 - c) * midpoints(200)
        return 4 * self.mu * self.P * self.a / np.pi * (
            c ** 3 * k_less_e(c) + 3 * np.mean(s * s * k_less_e(s)) * (1 - c))

    def shear(self, r, c):
        """Discs of all radii from c to 1 that turned one after the other."""
        if r >= c * self.a:
            return self.mu * self.pressure(r)
        x = r / self.a
        low, high = np.sqrt(c * c - x * x), np.sqrt(1 - x * x)
        v = low + (high - low) * midpoints(400)
        s = np.sqrt(x * x + v * v)
        E = elliptic(np.sqrt(1 - s * s))[1]
        return self.mu * self.p0 * 2 / np.pi * x * np.mean(
            E / (s * s)) * (high - low)


# ---- nonlocal friction -------------------------------------------------

def bump(s):
    """The mollifier exp(1/(s^2 - 1)) of mass 1 on ]-1, 1[."""
    inside = np.abs(s) < 1
    return np.where(inside, np.exp(1 / (np.where(inside, s, 0) ** 2 - 1)),
                    0.0) / 0.44399381616808


def edge_mass(s):
    """Mass of the bump on [-s, 1]: what an edge at the distance s leaves."""
    t = 2 * midpoints(4000) - 1
    return np.array([np.sum(bump(t) * (t > -v)) / 2000 for v in s])


# ---- time --------------------------------------------------------------

def heun(rate, y, steps, h, every):
    """y after every so many of the steps of Heun's method: times, states."""
    t, kept = 0.0, []
    for i in range(steps):
        d = rate(t, y)
        y = y + h / 2 * (d + rate(t + h, y + h * d))
        t = (i + 1) * h
        if (i + 1) % every == 0:
            kept.append((t, y))
    return np.array([k[0] for k in kept]), np.array([k[1] for k in kept])


def chaboche(strain, cycles):
    """Bar of Chaboche's law under strain*sin(2 pi t): strain, stress."""
    E, sy, K, n, Q, b = 1e5, 60.0, 150.0, 3.0, 20.0, 50.0
    C, g = np.array([2e4, 5e3]), np.array([100.0, 20.0])

    def rate(t, y):  # plastic strain, its length, back strains
        beyond = E * (strain * np.sin(2 * np.pi * t) - y[0]) - C @ y[2:]
        over = (abs(beyond) - sy - Q * (1 - np.exp(-b * y[1]))) / K
        r = over ** n if over > 0 else 0.0
        d = r * np.sign(beyond)
        return np.array([d, r, *(d - g * y[2:] * r)])

    t, y = heun(rate, np.zeros(4), 1000 * cycles, 1e-3, 5)
    eps = strain * np.sin(2 * np.pi * t)
    return t, eps, E * (eps - y[:, 0])


def hanging_bar(periods, E=1e3, q=1.0, tau=0.5, rise=3e-3):
    """Maxwell bar on a floor that moves: times, pressure."""
    def down(t):
        return rise * np.sin(2 * np.pi * t)

    def stress(t, ei):
        return np.minimum(E * (down(t) - ei), q)

    def rate(t, ei):
        return (1 + 0.5 * np.cos(2 * np.pi * t)) / tau * stress(t, ei) / E

    t, ei = heun(rate, 0.0, 2000 * periods, 1 / 2000, 10)
    return t, down(t), q - stress(t, ei)


def lee_radok(line, tau, x, t):
    """Pressure of a Maxwell cylinder under a load since time 0."""
    def a2(s):
        return line.a ** 2 * (1 + s / tau)

    start = np.where(x * x > a2(0), (x * x / a2(0) - 1) * tau, 0.0)
    w = midpoints(400)[:, None] * np.sqrt(np.maximum(t - start, 0))
    s = start + w * w  # from the time at which the contact reaches x
    past = np.sum(2 * w * np.sqrt(np.maximum(t - start, 0)) / 400
                  * np.exp(-(t - s) / tau) * a2(0) / tau / 2
                  / np.sqrt(np.maximum(a2(s) - x * x, 1e-300)), axis=0)
    found = line.E / (2 * line.R) * (np.exp(-t / tau) * root(a2(0) - x * x)
                                     + past)
    return np.where(x * x < a2(t), found, 0.0)
