/** The input that fits a parameter, or a field of its value: what there is to choose is offered, all else can be typed. */
import { Button, NativeSelect, Paper, SimpleGrid, Stack, Switch, Text } from '@mantine/core'
import { IconPlus } from '@tabler/icons-react'
import { useId, useState } from 'react'
import { lookup, type Dict } from '../../document/dict'
import {
  fieldProblem,
  isTemplate,
  limitsText,
  looseValue,
  shownValue,
  typedValue,
  withField,
  type EditField,
} from '../../document/editing/fields'
import { offersOf, unknownName, type Surroundings } from '../../document/editing/offers'
import { waypointWords } from '../../document/editing/waypoints'
import { plainText } from '../../document/values'
import { Words } from '../../components/Words'
import { EntryDetails } from './EntryDetails'
import { RecordList } from './RecordList'
import { TemplateInput } from './TemplateInput'

export interface ParameterInputProps {
  readonly field: EditField
  readonly value: unknown
  /** It is written as an expression. */
  readonly isFree: boolean
  readonly around: Surroundings
  /** Where it stands, before the name of the field: `target` of `target frame`. */
  readonly within?: string
  readonly hintId: string
  readonly isInvalid: boolean
  readonly onSet: (value: unknown) => void
  /** A choice of the opened list is pointed at. */
  readonly onPoint?: (option: string | undefined) => void
}

export function ParameterInput(props: ParameterInputProps) {
  const { field, value, isFree, around, within, hintId, isInvalid, onSet } = props
  const label = within ? `${within} ${field.name}` : field.name
  const fallback = shownValue(field.fallback)
  const shared = { label, describedBy: hintId, isInvalid, placeholder: field.required ? '' : fallback || 'not given' }
  if (isFree) {
    const shown = value === undefined ? '${' : shownValue(value)
    return (
      <TemplateInput
        {...shared}
        isMono
        value={shown === '${' ? '' : shown}
        placeholder="${name}"
        onCommit={(typed) => onSet(typedValue(field, typed))}
      />
    )
  }
  switch (field.kind) {
    case 'boolean':
      return (
        <Switch
          size="sm"
          aria-label={label}
          checked={(value ?? field.fallback) === true}
          onChange={(event) => onSet(event.currentTarget.checked)}
        />
      )
    case 'choice':
      return (
        <NativeSelect
          size="xs"
          aria-label={label}
          aria-describedby={hintId}
          value={plainText(value)}
          data={[{ value: '', label: field.required ? 'choose' : `default${fallback ? `: ${fallback}` : ''}` }, ...field.choices]}
          onChange={(event) => onSet(event.currentTarget.value === '' ? undefined : event.currentTarget.value)}
        />
      )
    case 'vector':
      return <VectorInput label={label} field={field} value={value} onSet={onSet} />
    case 'record':
      return <RecordInput {...props} label={label} />
    case 'list':
      return <ListInput {...props} label={label} />
    case 'entry':
      return <EntryInput {...props} shared={shared} label={label} />
    default:
      return (
        <TemplateInput
          {...shared}
          isMono={field.kind === 'data'}
          options={offersOf(field, around) ?? NOTHING}
          inputMode={field.kind === 'number' || field.kind === 'integer' ? 'decimal' : 'text'}
          value={shownValue(value)}
          onCommit={(typed) => onSet(typedValue(field, typed))}
        />
      )
  }
}

const NOTHING: readonly string[] = []
/** More numbers stand in rows of three. */
const MOST_BESIDE = 4
const IN_ROW = 3

interface VectorProps {
  readonly label: string
  readonly field: EditField
  readonly value: unknown
  readonly onSet: (value: unknown) => void
}

/** Numbers beside one another, `x`, `y`, `z`. */
function VectorInput({ label, field, value, onSet }: VectorProps) {
  const given = Array.isArray(value) ? (value as unknown[]) : undefined
  const base = given ?? (Array.isArray(field.fallback) ? (field.fallback as unknown[]) : field.parts.map(() => 0))
  const columns = field.parts.length > MOST_BESIDE ? IN_ROW : field.parts.length
  return (
    <SimpleGrid cols={columns} spacing={5} verticalSpacing={5}>
      {field.parts.map((part, index) => (
        <TemplateInput
          key={part}
          label={`${label} ${part}`}
          inputMode="decimal"
          value={given ? shownValue(given[index]) : ''}
          placeholder={shownValue(base[index]) || part}
          onCommit={(typed) => onSet(field.parts.map((_, at) => (at === index ? looseValue(typed || '0') : base[at])))}
        />
      ))}
    </SimpleGrid>
  )
}

/** A list of values with fields; as text where it is something else. */
function ListInput({ field, value, around, label, hintId, onSet }: ParameterInputProps & { readonly label: string }) {
  const { item } = field
  const given = value ?? field.fallback ?? NOTHING
  if (!item || !Array.isArray(given)) return <DataInput label={label} hintId={hintId} value={value} onSet={onSet} />
  const items: readonly unknown[] = given
  return (
    <RecordList label={label} items={items} words={(each) => waypointWords({ value: each, place: undefined })} onSet={onSet}>
      {(at) => (
        <RecordInput
          field={item}
          value={items[at]}
          isFree={false}
          isInvalid={false}
          around={around}
          label={`${label} ${at}`}
          hintId={hintId}
          onSet={(next) => onSet(items.with(at, next ?? {}))}
        />
      )}
    </RecordList>
  )
}

interface DataProps {
  readonly label: string
  readonly hintId: string
  readonly value: unknown
  readonly onSet: (value: unknown) => void
}

/** A value of another type than the one of its field. */
function DataInput({ label, hintId, value, onSet }: DataProps) {
  return (
    <TemplateInput
      label={label}
      isMono
      isLong
      isInvalid
      describedBy={hintId}
      value={shownValue(value)}
      onCommit={(typed) => onSet(typedValue({ kind: 'data' }, typed))}
    />
  )
}

/** A value with fields: each of them in the input that fits it. */
function RecordInput({ field, value, around, label, hintId, onSet }: ParameterInputProps & { readonly label: string }) {
  const [isOpened, setOpened] = useState(false)
  const given = recordOf(value)
  if (value !== undefined && value !== null && !given) return <DataInput label={label} hintId={hintId} value={value} onSet={onSet} />
  if (!given && !isOpened) {
    return (
      <Button
        variant="default"
        size="compact-xs"
        leftSection={<IconPlus size={13} aria-hidden />}
        aria-label={`Set the fields of ${label}`}
        onClick={() => setOpened(true)}
      >
        Set its fields
      </Button>
    )
  }
  return (
    <Paper withBorder p="xs" role="group" aria-label={label}>
      <Stack gap={6}>
        {field.properties.map((inner) => (
          <RecordField
            key={inner.name}
            field={inner}
            value={lookup(given, inner.name)}
            around={around}
            within={label}
            isStarted={given !== undefined}
            onSet={(next) => onSet(withField(given ?? {}, inner.name, next))}
          />
        ))}
      </Stack>
    </Paper>
  )
}

interface RecordFieldProps {
  readonly field: EditField
  readonly value: unknown
  readonly around: Surroundings
  readonly within: string
  /** Some field of the value is given already: those that are required are missed. */
  readonly isStarted: boolean
  readonly onSet: (value: unknown) => void
}

function RecordField({ field, value, around, within, isStarted, onSet }: RecordFieldProps) {
  const hintId = useId()
  const isMissing = value === undefined && !isStarted
  const problem = isMissing ? undefined : (fieldProblem(field, value) ?? unknownName(field, value, around))
  return (
    <div data-problem={problem !== undefined || undefined}>
      <Text size="xs" fw={560}>
        {field.name}{' '}
        <Text span inherit c="dimmed" fw={400}>
          {limitsText(field)}
        </Text>
      </Text>
      <ParameterInput
        field={field}
        value={value}
        isFree={isTemplate(value)}
        around={around}
        within={within}
        hintId={hintId}
        isInvalid={problem !== undefined}
        onSet={onSet}
      />
      <Text size="xs" c={problem ? 'var(--failed)' : 'dimmed'} id={hintId}>
        <Words text={problem ?? field.description} />
      </Text>
    </div>
  )
}

interface EntryProps extends ParameterInputProps {
  readonly label: string
  readonly shared: {
    readonly label: string
    readonly describedBy: string
    readonly isInvalid: boolean
    readonly placeholder: string
  }
}

/** A named entry of the store, to be chosen from those of its kind; or the value itself. */
function EntryInput(props: EntryProps) {
  const { field, value, around, shared, onSet, onPoint } = props
  const named = nameIn(value)
  const isData = value !== undefined && value !== null && named === undefined
  if (isData && recordOf(value) && field.properties.length > 0)
    return (
      <Stack gap={4}>
        <RecordInput {...props} />
        <Button variant="subtle" size="compact-xs" style={{ alignSelf: 'start' }} onClick={() => onSet(undefined)}>
          Choose an entry instead
        </Button>
      </Stack>
    )
  if (isData)
    return (
      <TemplateInput {...shared} isMono isLong value={shownValue(value)} onCommit={(typed) => onSet(typedValue({ kind: 'data' }, typed))} />
    )
  const offers = offersOf(field, around) ?? []
  const chosen = around.entries.find((entry) => entry.name === named && (!field.entryKind || entry.kind === field.entryKind))
  return (
    <>
      <TemplateInput
        {...shared}
        placeholder={offers.length > 0 ? 'choose an entry' : 'name of an entry'}
        options={offers}
        {...(onPoint ? { onPoint } : {})}
        value={named ?? ''}
        onCommit={(typed) => {
          if (typed === '') onSet(undefined)
          else if (typed.startsWith('{') || typed.startsWith('[')) onSet(looseValue(typed))
          else onSet(field.isPlainEntry ? typed : { entry: typed })
        }}
      />
      {chosen && <EntryDetails kind={chosen.kind} name={chosen.name} />}
    </>
  )
}

function nameIn(value: unknown): string | undefined {
  if (typeof value === 'string') return value
  const record = recordOf(value)
  const entry = lookup(record, 'entry')
  return record && Object.keys(record).length === 1 && typeof entry === 'string' ? entry : undefined
}

function recordOf(value: unknown): Dict<unknown> | undefined {
  return typeof value === 'object' && value !== null && !Array.isArray(value) ? (value as Dict<unknown>) : undefined
}
