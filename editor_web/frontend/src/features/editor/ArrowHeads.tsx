/** Heads of arrows as markers, each in its colour, with the name by which lines use it. */

export function ArrowHeads({ colours }: { colours: Readonly<Record<string, string>> }) {
  return (
    <defs>
      {Object.entries(colours).map(([id, colour]) => (
        <marker key={id} id={id} viewBox="0 0 10 10" refX="8.5" refY="5" markerWidth="7" markerHeight="7" orient="auto">
          <path d="M 0 1 L 9 5 L 0 9 z" style={{ fill: colour }} />
        </marker>
      ))}
    </defs>
  )
}
