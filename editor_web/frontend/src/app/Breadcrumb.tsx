/** The way from the root to the selected node. */
import { nameOfPath, pathsTo } from '../document/path'

export function Breadcrumb({ selected, onSelect }: { selected: string | undefined; onSelect: (path: string) => void }) {
  if (!selected) return null
  const paths = pathsTo(selected)
  return (
    <nav aria-label="Path of the selection" className="breadcrumb">
      <ol>
        {paths.map((path) => (
          <li key={path}>
            <button type="button" aria-current={path === selected ? 'location' : undefined} onClick={() => onSelect(path)}>
              {nameOfPath(path)}
            </button>
          </li>
        ))}
      </ol>
    </nav>
  )
}
