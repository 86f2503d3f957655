"""The paper's studies, each with its rows, its figures and what the terminal shows of it."""
