"""How a page's camera shows the robots, for what is drawn over the picture."""

from __future__ import annotations

import numpy as np
import viser
from viser.transforms import SO3

from onpath.app.scene.stage import FIELD_OF_VIEW, FIRST_SIZE, Pose, Stage, view_of
from onpath.app.view.state_message import Projection
from onpath.models.systems.robots import Robot


def seen_at_first(stage: Stage, robot: Robot) -> Projection:
    """How the robots of a stage are seen before a camera has reported; see `set_initial_camera`."""
    return seen_from(view_of(stage, FIRST_SIZE), stage, robot)


def seen_by(camera: viser.CameraHandle, stage: Stage, robot: Robot) -> Projection:
    """How a camera shows the robots of a stage."""
    pose = Pose(np.asarray(camera.position), np.asarray(camera.look_at))
    return _seen(True, pose, np.asarray(camera.wxyz), camera.fov, stage, robot)


def seen_from(pose: Pose, stage: Stage, robot: Robot) -> Projection:
    """How the robots of a stage will be shown by a camera that is placed there, upright."""
    forward = pose.look_at - pose.position
    right = np.cross(forward, [0.0, 0.0, 1.0])
    down = np.cross(forward, right)
    axes = [each / np.linalg.norm(each) for each in (right, down, forward)]
    wxyz = SO3.from_matrix(np.column_stack(axes)).wxyz
    return _seen(False, pose, wxyz, float(FIELD_OF_VIEW), stage, robot)


def _seen(
    drawn: bool, pose: Pose, wxyz: np.ndarray, fov: float, stage: Stage, robot: Robot
) -> Projection:
    distance = np.linalg.norm(pose.look_at - pose.position)
    return Projection(
        drawn=drawn,
        height=float(2 * distance * np.tan(fov / 2)),
        cameras=projections(pose.position, wxyz, fov, stage.origins, robot),
        above=robot.output_at(stage.title),
        arrow=stage.force_scale,
    )


def projections(
    position: np.ndarray, wxyz: np.ndarray, fov: float, origins: np.ndarray, robot: Robot
) -> np.ndarray:
    """Matrices of the perspective of the robots' end-points, shape (k, 3, p + 1).

    Applied to (y, 1), a matrix gives (x, y, z): x / z and y / z are right and down from the middle
    of the picture, as shares of its height; z is the distance along the camera's axis, [m].

    Args:
        position: of the camera, shape (3,), [m].
        wxyz: its orientation, a quaternion: it looks along its z axis, y is down.
        fov: its vertical field of view, [rad].
        origins: of the robots' frames, shape (k, 3), [m].
    """
    onto = SO3(np.asarray(wxyz)).as_matrix().T
    onto[:2] /= 2 * np.tan(fov / 2)
    offsets = origins + np.array(robot.home) - position
    return np.stack([np.column_stack([onto @ robot.axes.T, onto @ each]) for each in offsets])
