/** Heads of arrows as markers: each has the name by which lines use it, which is its class too. */

export function ArrowHeads({ ids }: { ids: readonly string[] }) {
  return (
    <defs>
      {ids.map((id) => (
        <marker key={id} id={id} viewBox="0 0 10 10" refX="8.5" refY="5" markerWidth="7" markerHeight="7" orient="auto">
          <path d="M 0 1 L 9 5 L 0 9 z" className={id} />
        </marker>
      ))}
    </defs>
  )
}
