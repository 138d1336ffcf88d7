"""Objects of any size have a mesh."""

import numpy as np
import pytest

from placing.errors import UnknownName
from placing.object_meshes import object_mesh


@pytest.mark.parametrize("size_m", [(0.3, 0.12, 0.1), (0.063, 0.072, 0.052)])
def test_a_mesh_fills_its_box_also_where_the_shape_has_no_room(size_m):
    mesh = object_mesh("bread", size_m)
    assert np.allclose(mesh.extents, size_m, atol=1e-6)
    assert mesh.is_volume


def test_a_shape_that_is_not_known_is_one_line():
    with pytest.raises(UnknownName, match="object shape"):
        object_mesh("loaf_of_nothing", (0.1, 0.1, 0.1))
