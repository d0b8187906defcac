"""Unit quaternions, Hamilton, stored x y z w; arrays of shape (..., 4).

A quaternion of a pose rotates body coordinates to world: p_w = R(q) p_b.
"""

import numpy as np


def normalized(q):
    """Scale quaternions (..., 4) to unit length."""
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def conjugate(q):
    """Inverse rotations of unit quaternions (..., 4)."""
    return q * np.array([-1.0, -1.0, -1.0, 1.0])


def multiply(a, b):
    """Hamilton products a b of quaternions (..., 4): R(a b) = R(a) R(b)."""
    av, aw = a[..., :3], a[..., 3:]
    bv, bw = b[..., :3], b[..., 3:]
    vector = aw * bv + bw * av + np.cross(av, bv)
    scalar = aw * bw - np.sum(av * bv, axis=-1, keepdims=True)
    return np.concatenate([vector, scalar], axis=-1)


def rotate(q, vectors):
    """Vectors (..., 3) rotated by unit quaternions (..., 4)."""
    axis, w = q[..., :3], q[..., 3:]
    twice_cross = 2.0 * np.cross(axis, vectors)
    return vectors + w * twice_cross + np.cross(axis, twice_cross)


def from_matrix(R):
    """The unit quaternion (4,), w >= 0, of one rotation matrix (3, 3).

    The eigenvector of Bar-Itzhack's symmetric 4x4 matrix with the largest
    eigenvalue ("New method for extracting the quaternion from a rotation
    matrix", 2000): no case distinction, and no division by a small number.
    """
    K = np.empty((4, 4))
    K[:3, :3] = R + R.T - np.trace(R) * np.eye(3)
    K[:3, 3] = K[3, :3] = R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]
    K[3, 3] = np.trace(R)
    q = np.linalg.eigh(K)[1][:, -1]
    return -q if q[3] < 0.0 else q


def angle(q):
    """Rotation angles (...) in [0, pi] rad of unit quaternions (..., 4)."""
    return 2.0 * np.arctan2(np.linalg.norm(q[..., :3], axis=-1), np.abs(q[..., 3]))


def yaw_and_tilt(q):
    """Split rotations of the world into a turn about z and a tilt of z.

    Swing-twist decomposition about the z axis: R(q) = R(tilt) R_z(yaw), where
    the tilt's axis is horizontal. So tilt is exactly the angle by which
    gravity's direction moves, and yaw is free of it.

    Args:
        q: unit quaternions (..., 4).
    Returns:
        yaw (...) in [-pi, pi] rad, tilt (...) in [0, pi] rad.
    """
    sign = np.where(q[..., 3] < 0.0, -1.0, 1.0)
    yaw = 2.0 * np.arctan2(sign * q[..., 2], sign * q[..., 3])
    tilt = 2.0 * np.arctan2(np.hypot(q[..., 0], q[..., 1]),
                            np.hypot(q[..., 2], q[..., 3]))
    return yaw, tilt


def slerp(q0, q1, u):
    """Spherical linear interpolation along the shorter arc (Shoemake, 1985).

    Args:
        q0, q1: unit quaternions (N, 4) at u = 0 and u = 1.
        u: (N,) in [0, 1].
    Returns:
        unit quaternions (N, 4).
    """
    cosine = np.sum(q0 * q1, axis=-1)
    q1 = np.where(cosine[:, None] < 0.0, -q1, q1)
    half = np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))
    # sin(u half) / sin(half) tends to u: linear weights where they are alike.
    near = half < 1e-6
    sine = np.where(near, 1.0, np.sin(half))
    w0 = np.where(near, 1.0 - u, np.sin((1.0 - u) * half) / sine)
    w1 = np.where(near, u, np.sin(u * half) / sine)
    return normalized(w0[:, None] * q0 + w1[:, None] * q1)
