/** What the run asks its operator; a question that has become void is gone. */
import { lookup } from '../../document/dict'
import { Group, Text } from '@mantine/core'
import { IconMessageQuestion, IconRoute } from '@tabler/icons-react'
import { useLive } from '../../api/live'
import type { GraphNode, GateWait } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { TextButton } from '../../components/TextButton'
import { requestsOf } from '../../document/runState'
import { nodeAt } from '../../document/tree'
import { isProposed, plansOf, planWords } from '../../document/plannedPaths'
import classes from './Requests.module.css'
import type { Commands } from './useCommands'

/** Where the key `a` goes. */
export const REQUESTS_ID = 'requests'

export interface RequestsProps {
  readonly root: GraphNode | null
  readonly commands: Commands
  readonly onShow: (path: string) => void
  /** Which run asks, where there are several. */
  readonly of?: string
  /** In a row of fixed height? */
  readonly isRow?: boolean
}

export function Requests({ root, commands, onShow, of, isRow = false }: RequestsProps) {
  const control = useLive((s) => s.control)
  const requests = requestsOf(control)
  return (
    <div aria-live="assertive" className={isRow ? classes.row : undefined}>
      {requests.length > 0 && (
        <section id={of ? undefined : REQUESTS_ID} aria-label={of ? `${of} asks` : 'The run asks'}>
          <ul className="plain-list">
            {requests.map((each) => (
              <Request
                key={each.path}
                request={each}
                outcomes={(root && nodeAt(root, each.path)?.outcomes) ?? []}
                commands={commands}
                onShow={onShow}
                isRow={isRow}
              />
            ))}
          </ul>
        </section>
      )}
    </div>
  )
}

interface RequestProps {
  readonly request: GateWait
  readonly outcomes: readonly string[]
  readonly commands: Commands
  readonly onShow: (path: string) => void
  readonly isRow: boolean
}

function Request({ request, outcomes, commands, onShow, isRow }: RequestProps) {
  const { path, outcome, required } = request
  // What answers a question is possible or not like any other command.
  const obstacle = commands.obstacle('autonomy')
  const others = outcomes.filter((each) => each !== outcome)
  const common = { obstacle, onObstacle: () => commands.explain('autonomy', 'Answer') }
  return (
    <li className={classes.request} aria-label={`Question of ${path}`}>
      <IconMessageQuestion size={20} color="var(--stopped)" style={{ flex: 'none' }} aria-hidden />
      <span className={classes.text}>
        <TextButton onPress={() => onShow(path)}>{path}</TextButton> wants to end with <strong>{outcome}</strong>
        {required && `, which requires ${required}`}
        <Planned path={path} isRow={isRow} />
      </span>
      <Group component="span" gap="3xs" flex="none" wrap={isRow ? 'nowrap' : 'wrap'}>
        <CommandButton {...common} label={`Agree: ${outcome}`} tone="strong" onPress={() => void commands.answer(path)} />
        {others.map((each) => (
          <CommandButton
            key={each}
            {...common}
            label={`Force outcome: ${each}`}
            hint={`End it with ${each}`}
            onPress={() => void commands.force(path, each)}
          />
        ))}
        <CommandButton {...common} label="Run again" hint="Run the node again from its start" onPress={() => void commands.repeat(path)} />
      </Group>
    </li>
  )
}

/** The way that an answer is about, which the 3D view shows until an arm goes it. */
function Planned({ path, isRow }: { readonly path: string; readonly isRow: boolean }) {
  const nodes = useLive((s) => s.nodes)
  const robots = useLive((s) => s.robots)
  return plansOf(nodes, path).map((plan) => (
    <Group component="span" key={plan.robot} gap="3xs" wrap="nowrap" title={planWords(plan)}>
      <IconRoute size={15} color="var(--active)" style={{ flex: 'none' }} aria-hidden />
      <Text span inherit truncate={isRow}>
        <strong>{plan.robot}</strong>: {planWords(plan)};{' '}
        {isProposed(lookup(robots, plan.robot)) ? 'shown in the 3D view' : 'no longer in the 3D view'}
      </Text>
    </Group>
  ))
}
