"""The synthesis of optimal laws: problems, their solution by CasADi and IPOPT, lower bounds and limits."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(
    __name__,
    {
        "optlaws.synthesis.arrays.problems": "ProblemArray map_arrays",
        "optlaws.synthesis.limits.closed_forms": "acceleration_limit limit",
        "optlaws.synthesis.limits.drive_limits": "DriveLimit drive_limit",
        "optlaws.synthesis.limits.laws": "limit_law",
        "optlaws.synthesis.pareto": "Front pareto_front",
        "optlaws.synthesis.problem.constants": "FUNCTIONALS B C C_minus C_plus D Functional J snap "
        "rms_c rms_j rms_snap",
        "optlaws.synthesis.problem.expression": "Expression Maximum Term maximum",
        "optlaws.synthesis.problem.problem": "Problem",
        "optlaws.synthesis.problem.ranges": "Range at_least at_most between",
        "optlaws.synthesis.problem.windows": "Window via",
        "optlaws.synthesis.proof.certificate": "Certificate",
        "optlaws.synthesis.proof.nodes": "Contact Leaf Split Tightening",
        "optlaws.synthesis.proven.front": "FrontPoint ProvenFront",
        "optlaws.synthesis.proven.refine": "proven_front",
        "optlaws.synthesis.solution": "Solution",
        "optlaws.synthesis.status": "Status",
        "optlaws.synthesis.solve": "synthesize",
        "optlaws.synthesis.solution_array": "SolutionArray",
        "optlaws.synthesis.solve_many": "sweep synthesize_array synthesize_chunks synthesize_many",
        "optlaws.synthesis.spaces.bases": "Basis Bernstein Chebyshev Pieces PolynomialBasis Powers basis",
        "optlaws.synthesis.spaces.end_conditions": "BoundaryConditions law_from_z",
        "optlaws.synthesis.spaces.splines": "BSplines PiecewiseBasis",
    },
)
