/** What no run of the sweep has executed: nodes that were never entered, exits that were never taken. */
import type { CoverageItem } from '../../api/types'

const FIRST = 60

export function MissedItems({ items, missing }: { readonly items: number; readonly missing: readonly CoverageItem[] }) {
  return (
    <>
      <p className="sweep-note">
        {items - missing.length} of {items} nodes and exits of the behavior were executed.
      </p>
      {missing.length > 0 && (
        <ul className="plain-list sweep-missing" aria-label="Never executed" tabIndex={0}>
          {missing.slice(0, FIRST).map((item) => (
            <li key={`${item.kind} ${item.path} ${item.name ?? ''} ${item.target ?? ''}`}>
              <span className="quiet">{item.kind.replace('_', ' ')}</span> <span className="mono">{item.path}</span>
              {item.name && (
                <span className="mono">
                  {' '}
                  —{item.name}→ {item.target}
                </span>
              )}
            </li>
          ))}
          {missing.length > FIRST && <li className="quiet">and {missing.length - FIRST} more</li>}
        </ul>
      )}
    </>
  )
}
