/** What a search for failures goes towards, how it chooses runs, and when it ends. */
import { useId } from 'react'
import type { SearchDraft } from '../../document/sweeps'

export const NEW_SEARCH: SearchDraft = { towards: 'failure', name: '', method: 'cross_entropy', stopAfter: '' }

export function SearchFields({ search, onChange }: { readonly search: SearchDraft; readonly onChange: (search: SearchDraft) => void }) {
  const list = useId()
  const note = useId()
  const change = (changed: Partial<SearchDraft>) => onChange({ ...search, ...changed })
  return (
    <fieldset className="sweep-factors">
      <legend className="visually-hidden">Search</legend>
      <div className="sweep-form-row">
        <label>
          Towards
          <select
            className="new-input"
            value={search.towards}
            onChange={(event) => change({ towards: event.currentTarget.value as SearchDraft['towards'] })}
          >
            <option value="failure">failures alone</option>
            <option value="least">the least of a number</option>
            <option value="most">the most of a number</option>
          </select>
        </label>
        {search.towards !== 'failure' && (
          <label>
            Number
            <input
              className="new-input mono"
              list={list}
              aria-describedby={note}
              placeholder="left.gripper.slip_max_m"
              value={search.name}
              onChange={(event) => change({ name: event.currentTarget.value })}
            />
            <datalist id={list}>
              <option value="duration_s" />
            </datalist>
          </label>
        )}
      </div>
      <p id={note} className="quiet sweep-note">
        {search.towards === 'failure'
          ? 'Runs near to those that failed are chosen more often.'
          : 'Of runs that succeed: duration_s, userdata at the end, or a measure. Choose one that says how near to failure they were.'}
      </p>
      <div className="sweep-form-row">
        <label>
          Method
          <select
            className="new-input"
            value={search.method}
            onChange={(event) => change({ method: event.currentTarget.value as SearchDraft['method'] })}
          >
            <option value="cross_entropy">cross-entropy</option>
            <option value="optuna">optuna</option>
          </select>
        </label>
        <label>
          Stop after, failures
          <input
            className="new-input"
            inputMode="numeric"
            placeholder="all runs"
            value={search.stopAfter}
            onChange={(event) => change({ stopAfter: event.currentTarget.value })}
          />
        </label>
      </div>
    </fieldset>
  )
}
