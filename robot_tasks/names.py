"""Names that every scene has."""

from typing import Final

TIP: Final = "tool_tip"
"""Site at the tip of the tool, whose pose is controlled."""
TOOL: Final = "tool_body"
"""Body of the tool."""
ARM_JOINTS: Final = tuple(f"joint_{i}" for i in range(1, 8))
"""Joints of the arm, from the base; they come first in every scene."""
N_JOINTS: Final = len(ARM_JOINTS)
