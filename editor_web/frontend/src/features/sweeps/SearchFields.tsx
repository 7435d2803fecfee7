/** What a search for failures goes towards, how it chooses runs, and when it ends. */
import { Fieldset, Group, NativeSelect, TextInput, VisuallyHidden } from '@mantine/core'
import { useId } from 'react'
import type { SearchDraft } from '../../document/sweeps'
import { Note } from './Note'

export const NEW_SEARCH: SearchDraft = { towards: 'failure', name: '', method: 'cross_entropy', stopAfter: '' }

export function SearchFields({ search, onChange }: { readonly search: SearchDraft; readonly onChange: (search: SearchDraft) => void }) {
  const list = useId()
  const note = useId()
  const change = (changed: Partial<SearchDraft>) => onChange({ ...search, ...changed })
  return (
    <Fieldset variant="unstyled" legend={<VisuallyHidden>Search</VisuallyHidden>}>
      <Group gap="xs" align="end">
        <NativeSelect
          flex="1 1 8rem"
          label="Towards"
          value={search.towards}
          onChange={(event) => change({ towards: event.currentTarget.value as SearchDraft['towards'] })}
        >
          <option value="failure">failures alone</option>
          <option value="least">the least of a number</option>
          <option value="most">the most of a number</option>
        </NativeSelect>
        {search.towards !== 'failure' && (
          <>
            <TextInput
              flex="1 1 8rem"
              label="Number"
              list={list}
              aria-describedby={note}
              placeholder="left.gripper.slip_max_m"
              value={search.name}
              onChange={(event) => change({ name: event.currentTarget.value })}
            />
            <datalist id={list}>
              <option value="duration_s" />
            </datalist>
          </>
        )}
      </Group>
      <Note isQuiet id={note}>
        {search.towards === 'failure'
          ? 'Runs near to those that failed are chosen more often.'
          : 'Of runs that succeed: duration_s, userdata at the end, or a measure. Choose one that says how near to failure they were.'}
      </Note>
      <Group gap="xs" align="end">
        <NativeSelect
          flex="1 1 8rem"
          label="Method"
          value={search.method}
          onChange={(event) => change({ method: event.currentTarget.value as SearchDraft['method'] })}
        >
          <option value="cross_entropy">cross-entropy</option>
          <option value="optuna">optuna</option>
        </NativeSelect>
        <TextInput
          flex="1 1 8rem"
          label="Stop after, failures"
          inputMode="numeric"
          placeholder="all runs"
          value={search.stopAfter}
          onChange={(event) => change({ stopAfter: event.currentTarget.value })}
        />
      </Group>
    </Fieldset>
  )
}
