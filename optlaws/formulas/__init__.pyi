from .arithmetic import NUMPY as NUMPY, evaluate as evaluate
from .reading import read as read
from .tree import Formula as Formula
